#pragma once
// Clients of a web server on this machine: HTTP requests, WebSockets and bare sockets. Everything
// fails that takes longer than ten seconds.
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightwalk::test {

/// Headers of a request; they replace those that a client sends by default.
using WebHeaders = std::vector<std::pair<std::string, std::string>>;

struct WebResponse {
    unsigned status = 0;  ///< 0: no answer
    std::map<std::string, std::string> headers;
    std::string body;
};

/// Send a request over a connection of its own.
WebResponse web_request(std::uint16_t port, const std::string& target,
                        const WebHeaders& headers = {}, const std::string& method = "GET",
                        const std::string& body = "");

class WebClient {
  public:
    /// Connect and upgrade; see status(). `receive_bytes`: size of the socket's receive buffer; 0:
    /// the system's default.
    explicit WebClient(std::uint16_t port, const WebHeaders& headers = {},
                       const std::string& target = "/walk", int receive_bytes = 0);
    ~WebClient();
    WebClient(const WebClient&) = delete;
    WebClient& operator=(const WebClient&) = delete;

    /// HTTP status of the handshake: 101 when the WebSocket is open, 0 without an answer.
    [[nodiscard]] unsigned status() const;
    /// Send a message; false when the socket is closed.
    bool send(std::string_view text);
    bool send_binary(std::string_view bytes);
    bool ping();
    /// The next message; nothing when the connection ended.
    std::optional<std::string> receive();
    /// Whether the last one received was binary.
    [[nodiscard]] bool binary() const;
    /// Read until the connection ends, and return the messages. See close_code().
    std::vector<std::string> receive_all();
    /// The code in the server's close frame; 0 when there was none.
    [[nodiscard]] unsigned close_code() const;
    [[nodiscard]] std::string close_reason() const;
    /// Close the WebSocket in order.
    void close();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

class BareSocket {
  public:
    explicit BareSocket(std::uint16_t port);
    ~BareSocket();
    BareSocket(BareSocket&&) noexcept;

    bool send(std::string_view bytes);
    /// The bytes received until the server closed the connection or the time was over.
    std::string receive(std::chrono::milliseconds time);
    [[nodiscard]] bool closed()
        const;  ///< whether receive() found that the server closed the connection

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The text of an upgrade request, for BareSocket.
std::string upgrade_text(std::uint16_t port);

}  // namespace lightwalk::test
