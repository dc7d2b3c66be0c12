#pragma once
// The walk's web server: assets over HTTP, conversations with browsers over WebSockets. What is
// said in them, and who is let in, stands in README.md beside this.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// A browser with an open WebSocket. Numbers rise from 1 and are not used again.
enum class ClientId : std::uint32_t {};

/// What is served at a path. The texts must outlive the server.
struct WebAsset {
    std::string_view path;          ///< "/", "/page/walk.js"
    std::string_view content_type;  ///< "text/javascript; charset=utf-8"
    std::string_view bytes;
};

/// How much the server takes, and how long it waits.
struct WebLimits {
    using Time = std::chrono::milliseconds;
    int clients = 8;
    int connections = 256;  ///< all sockets; more are closed at once
    int saves = 4;          ///< requests of /save/ that wait for their answer
    std::size_t header_bytes = std::size_t{16} * 1024;
    std::size_t message_bytes = std::size_t{64} * 1024;
    /// Of a client, on average; pings count as well. A page on a screen of 240 Hz sends a view and
    /// an acknowledgement for each picture.
    double messages_per_second = 500;
    double messages_at_once = 1000;
    std::size_t text_bytes =
        std::size_t{1024} * 1024;  ///< that wait for a slow reader before it is closed
    std::size_t frames = 4;        ///< binary messages that do
    Time request{5'000};  ///< from connecting, or from the answer before, to a whole request
    Time answer{60'000};  ///< until an answer has been taken
    /// Of a WebSocket; after half of it it is pinged. One that broke the protocol and does not
    /// leave is cut off in half of it, too.
    Time silence{20'000};
    Time close_timeout{2'000};  ///< from the decision to close a WebSocket until its socket is cut
};

struct WebServerOptions {
    std::string address = "127.0.0.1";  ///< as numbers, or "localhost"
    std::uint16_t port = 8080;          ///< 0: any that is free
    std::string token;                  ///< empty: none is demanded; see make_token()
    WebLimits limits;
};

struct WebAnswer {
    unsigned status = 200;
    std::string content_type = "text/plain; charset=utf-8";
    std::string bytes;
    std::string file_name;  ///< to save it under; empty: none. Letters, digits, "._-".
};

/// Answers one request, once: further answers are ignored. Copies are the same; when the last is
/// gone without an answer the browser gets a 503. Any thread may call it, also after the server is
/// gone.
class WebReply {
  public:
    explicit WebReply(std::function<void(WebAnswer)> deliver);
    void operator()(WebAnswer answer) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

/// The program behind the server. Called on the server's thread, one call at a time: a long one
/// keeps everybody waiting. What it throws ends WebServer::run(), but for InputError in message()
/// and save().
class WebHandler {
  public:
    virtual ~WebHandler() = default;
    virtual void opened(ClientId client) = 0;
    /// An InputError closes this client with its text as reason.
    virtual void message(ClientId client, std::string_view text) = 0;
    /// Once for every one that opened, as soon as it is decided; then nothing more comes from it.
    virtual void closed(ClientId client) = 0;
    /// A request for `path`, which begins with "/save/". An InputError becomes its answer (503).
    virtual void save(const std::string& path, WebReply reply) = 0;
};

/// Listens from construction on, works in run().
class WebServer {
  public:
    /// `handler` must outlive the server. Throws InputError "address:port: why" when it cannot
    /// listen there.
    WebServer(WebServerOptions options, const std::vector<WebAsset>& assets, WebHandler& handler);
    /// run() must have returned.
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    [[nodiscard]] std::uint16_t port() const;  ///< the one that it listens on
    /// "http://host:port/", with the token where one is demanded: what to open in a browser.
    [[nodiscard]] std::string url() const;

    /// Serve, on the caller's thread, until stop(). Once.
    void run();

    // Any thread may call these, at any time in the server's life. A client that is gone is no
    // error: nothing happens.
    /// Say farewell to all and let run() return, after WebLimits::farewell at the latest.
    void stop(std::string reason = "the server ends");
    void send_text(ClientId client, std::string text);
    /// The bytes are shared, not copied: one frame goes to many.
    void send_binary(ClientId client, std::shared_ptr<const std::string> bytes);
    /// A bye with the reason behind what waits to be sent (frames aside), then the end.
    void close(ClientId client, std::string reason);

  private:
    class Core;
    void send(ClientId client, std::shared_ptr<const std::string> bytes, bool binary);
    std::shared_ptr<Core> core_;
};

}  // namespace lightwalk
