#pragma once
// One page's WebSocket to the run that draws its walk.
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/net/beast.h"
#include "io/net/web_server.h"

namespace lightwalk {

/// Where the web server of a run is.
struct RunPlace {
    std::vector<boost::asio::ip::tcp::endpoint> endpoints;  ///< of the same server
    std::string token;                                      ///< that it demands
};

/// Receives the events of links, on the thread of their context.
class RunLinkHost {
  public:
    virtual ~RunLinkHost() = default;
    virtual void came(ClientId client, std::shared_ptr<const std::string> bytes, bool binary) = 0;
    /// The link is of no use any more. Called once, and never after RunLink::stop().
    /// @param refusal  why the run wants to hear no more of this client; nothing: the run is gone,
    ///                 or cannot be reached
    virtual void ended(ClientId client, const std::optional<std::string>& refusal) = 0;
};

/// All member functions must be called on the thread of the context.
class RunLink final : public std::enable_shared_from_this<RunLink> {
  public:
    /// `host` must outlive the link, or its stop().
    RunLink(boost::asio::io_context& context, ClientId client, RunLinkHost& host);

    void open(const RunPlace& place);
    /// Append to the queue of outgoing texts, which waits until the link is open. False, and the
    /// link is as it was, when more than a megabyte would wait.
    [[nodiscard]] bool send(std::string text);
    void stop();

  private:
    void on_connect(boost::beast::error_code error);
    void on_open(boost::beast::error_code error);
    void read();
    void on_read(boost::beast::error_code error);
    void write();
    void on_write(boost::beast::error_code error);
    void end(const std::optional<std::string>& refusal);

    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
    boost::beast::flat_buffer received_;
    std::deque<std::string> waiting_;  ///< while writing_ its first is being written
    std::string target_;
    ClientId client_;
    RunLinkHost& host_;
    std::size_t waiting_bytes_ = 0;
    bool open_ = false, writing_ = false, ended_ = false;
};

}  // namespace lightwalk
