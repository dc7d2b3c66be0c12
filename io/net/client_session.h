#pragma once
// One WebSocket of the web server, from its upgrade to its end.
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "io/net/beast.h"
#include "io/net/connection.h"
#include "io/net/web_rules.h"
#include "io/net/web_server.h"

namespace lightwalk {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Whom a client's session reports to.
class ClientHost {
  public:
    virtual ~ClientHost() = default;
    virtual void opened(ClientId client) = 0;
    virtual void message(ClientId client, std::string_view text) = 0;
    /// Once; `opened`: whether it had been. The session's owner may let go of it.
    virtual void closed(ClientId client, bool opened) = 0;
};

/// All members are called on the server's thread, by who holds a shared pointer to it.
class ClientSession final : public Connection, public std::enable_shared_from_this<ClientSession> {
  public:
    ClientSession(boost::beast::tcp_stream stream, ClientId id, const WebLimits& limits,
                  ClientHost& host, List& list);

    void accept(const HttpRequest& request);
    /// Behind what waits. A client that leaves too much waiting is cut off.
    void send(std::shared_ptr<const std::string> bytes, bool binary);
    /// An orderly end: a bye behind the texts that wait, then a close frame; cut off if that takes
    /// too long.
    void end(boost::beast::websocket::close_code code, const std::string& reason);
    void stop(const std::string& reason) override;

  private:
    struct Outgoing {
        std::shared_ptr<const std::string> bytes;
        bool binary = false;
    };
    void on_accept(boost::beast::error_code error);
    void read();
    void on_read(boost::beast::error_code error);
    void write();
    void on_write(boost::beast::error_code error);
    void on_control();
    void cut();
    void leave();

    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
    boost::asio::steady_timer close_timer_;
    boost::beast::flat_buffer received_;
    std::deque<Outgoing> waiting_;  ///< the first is being written, while writing_
    boost::beast::websocket::close_reason reason_;
    RateLimit rate_;
    ClientId id_;
    const WebLimits& limits_;
    ClientHost& host_;
    std::size_t text_bytes_ = 0, frames_ = 0;  ///< in waiting_
    bool open_ = false, writing_ = false;
    bool ended_ = false;    ///< nothing is taken from it or for it any more
    bool left_ = false;     ///< the host knows
    bool flooded_ = false;  ///< by control frames
};

}  // namespace lightwalk
