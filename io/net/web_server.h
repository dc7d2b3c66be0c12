#pragma once
// The web server of a walk: assets over HTTP, messages over WebSockets. The messages, and the rules
// for requests, are in io/net/README.md.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// The number of a browser with an open WebSocket. Numbers rise from 1 and are not reused.
enum class ClientId : std::uint32_t {};

/// A file that is served at a path. The texts must outlive the server.
struct WebAsset {
    std::string_view path;          ///< "/", "/page/walk.js"
    std::string_view content_type;  ///< "text/javascript; charset=utf-8"
    std::string_view bytes;
};

/// Limits of what the server accepts, and its timeouts.
struct WebLimits {
    using Time = std::chrono::milliseconds;
    int clients = 8;
    int connections = 256;  ///< number of all sockets; further ones are closed at once
    int saves = 4;          ///< number of requests for /save/ that wait for their answer
    std::size_t header_bytes = std::size_t{16} * 1024;
    std::size_t message_bytes = std::size_t{64} * 1024;
    /// Messages of a client, on average; pings count as well. A page on a screen of 240 Hz sends a
    /// view and an acknowledgement for each picture.
    double messages_per_second = 500;
    double messages_at_once = 1000;
    std::size_t text_bytes =
        std::size_t{1024} * 1024;  ///< texts in the queue of a slow client before it is closed
    std::size_t frames = 4;        ///< binary messages in the queue before it is closed
    Time request{5'000};           ///< from connecting, or from the last answer, to a whole request
    Time answer{60'000};           ///< until the client has received an answer
    /// A WebSocket that sends nothing for so long is closed; after half of the time it is pinged. A
    /// client that broke the protocol has half of the time to close its side.
    Time silence{20'000};
    Time close_timeout{2'000};  ///< from the decision to close a WebSocket until its socket is cut
};

struct WebServerOptions {
    std::string address = "127.0.0.1";  ///< numeric, or "localhost"
    int port = 8080;                    ///< 0: any free port; at most 65535
    std::string token;                  ///< see make_token(); with an empty one none is demanded
    WebLimits limits;
    /// Origins of pages that may show this one within them, with spaces between them; "": none.
    std::string embedders = {};
};

struct WebAnswer {
    unsigned status = 200;
    std::string content_type = "text/plain; charset=utf-8";
    std::string bytes;
    std::string file_name;  ///< name for the download, of letters, digits, "._-"; empty for none
};

/// Answers one request; only the first call has an effect. All copies answer the same request; when
/// the last of them is destroyed without an answer the browser gets a 503. Any thread may call it,
/// also after the server is destroyed.
class WebReply {
  public:
    explicit WebReply(std::function<void(WebAnswer)> deliver);
    void operator()(WebAnswer answer) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

/// The program behind the server. It is called on the server's thread, one call at a time, so a
/// long call delays all clients. An exception ends WebServer::run(), except InputError in message()
/// and save().
class WebHandler {
  public:
    virtual ~WebHandler() = default;
    virtual void opened(ClientId client) = 0;
    /// A message of a client. An InputError closes the client, with its text as the reason.
    virtual void message(ClientId client, std::string_view text) = 0;
    /// Called once for every client that opened, as soon as its end is decided; no more messages of
    /// it follow.
    virtual void closed(ClientId client) = 0;
    /// A request for `path`, which begins with "/save/". An InputError becomes the answer (503).
    virtual void save(const std::string& path, WebReply reply) = 0;
};

/// Sends messages to browsers, from any thread. For a client that has disconnected nothing happens.
class WebSender {
  public:
    virtual ~WebSender() = default;
    virtual void send_text(ClientId client, std::string text) = 0;
    /// The bytes are shared, not copied, as one frame is sent to many clients.
    virtual void send_binary(ClientId client, std::shared_ptr<const std::string> bytes) = 0;
    /// Disconnect a client, after the texts in its queue and a `bye` with the reason; frames in its
    /// queue are dropped.
    virtual void close(ClientId client, std::string reason) = 0;
};

/// Listens from construction on; serves in run().
class WebServer final : public WebSender {
  public:
    /// `handler` must outlive the server. Throws InputError "address:port: why" when it cannot
    /// listen there.
    WebServer(WebServerOptions options, const std::vector<WebAsset>& assets, WebHandler& handler);
    /// run() must have returned.
    ~WebServer() override;
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    [[nodiscard]] std::uint16_t port() const;  ///< the port that it listens on
    /// The address to open in a browser: "http://host:port/", with the token where one is demanded.
    [[nodiscard]] std::string url() const;

    /// Serve on the caller's thread until stop(). May be called once.
    void run();

    // Any thread may call the following at any time. For a client that has disconnected they do
    // nothing.
    /// Close all connections and let run() return, after WebLimits::close_timeout at the latest.
    void stop(std::string reason = "the server ends");
    void send_text(ClientId client, std::string text) override;
    void send_binary(ClientId client, std::shared_ptr<const std::string> bytes) override;
    void close(ClientId client, std::string reason) override;

  private:
    class Core;
    void send(ClientId client, std::shared_ptr<const std::string> bytes, bool binary);
    std::shared_ptr<Core> core_;
};

}  // namespace lightwalk
