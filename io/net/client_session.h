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

/// Receives the events of client sessions.
class ClientHost {
  public:
    virtual ~ClientHost() = default;
    virtual void opened(ClientId client) = 0;
    virtual void message(ClientId client, std::string_view text) = 0;
    /// Called once for each session; `opened`: whether opened() had been called for it. The owner
    /// may release the session.
    virtual void closed(ClientId client, bool opened) = 0;
};

/// All member functions must be called on the server's thread, while a shared pointer to the
/// session is held.
class ClientSession final : public Connection, public std::enable_shared_from_this<ClientSession> {
  public:
    ClientSession(boost::beast::tcp_stream stream, ClientId id, const WebLimits& limits,
                  ClientHost& host, List& list);

    void accept(const HttpRequest& request);
    /// Append a message to the queue of outgoing ones. A client whose queue exceeds the limits is
    /// disconnected.
    void send(std::shared_ptr<const std::string> bytes, bool binary);
    /// End the session in order: a `bye` after the texts in the queue, then a close frame. The
    /// socket is closed when that takes longer than WebLimits::close_timeout.
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
    std::deque<Outgoing> waiting_;  ///< the queue; while writing_ its first is being written
    boost::beast::websocket::close_reason reason_;
    RateLimit rate_;
    ClientId id_;
    const WebLimits& limits_;
    ClientHost& host_;
    std::size_t text_bytes_ = 0, frames_ = 0;  ///< texts [bytes] and frames in waiting_
    bool open_ = false, writing_ = false;
    bool ended_ = false;    ///< no more messages are accepted in either direction
    bool left_ = false;     ///< ClientHost::closed() has been called
    bool flooded_ = false;  ///< the client has sent more control frames than the rate limit allows
};

}  // namespace lightwalk
