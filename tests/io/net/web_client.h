#pragma once
// The other end of a web server: HTTP requests, WebSockets and bare sockets to a port of this
// machine. Whatever takes longer than ten seconds counts as failed.
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

/// Replace those that a client sends by itself, too.
using WebHeaders = std::vector<std::pair<std::string, std::string>>;

struct WebResponse {
    unsigned status = 0;  ///< 0: no answer
    std::map<std::string, std::string> headers;
    std::string body;
};

/// One request over a connection of its own.
WebResponse web_request(std::uint16_t port, const std::string& target,
                        const WebHeaders& headers = {}, const std::string& method = "GET",
                        const std::string& body = "");

class WebClient {
  public:
    /// Upgrade; see status(). `receive_bytes`: of the socket's buffer, 0: as the system has it.
    explicit WebClient(std::uint16_t port, const WebHeaders& headers = {},
                       const std::string& target = "/walk", int receive_bytes = 0);
    ~WebClient();
    WebClient(const WebClient&) = delete;
    WebClient& operator=(const WebClient&) = delete;

    /// Of the handshake: 101 when it is open; 0: no answer.
    [[nodiscard]] unsigned status() const;
    /// False when the socket does not take it any more.
    bool send(std::string_view text);
    bool send_binary(std::string_view bytes);
    bool ping();
    /// The next message; nothing when the connection ended.
    std::optional<std::string> receive();
    /// Whether the last one received was binary.
    [[nodiscard]] bool binary() const;
    /// Read until the connection ends; the messages on the way. See close_code().
    std::vector<std::string> receive_all();
    /// What the other side's close frame said; 0: there was none.
    [[nodiscard]] unsigned close_code() const;
    [[nodiscard]] std::string close_reason() const;
    /// An orderly end.
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
    /// What came within the time, until the other side closed or the time was over.
    std::string receive(std::chrono::milliseconds time);
    [[nodiscard]] bool closed() const;  ///< by the other side, as receive() found

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Upgrade by hand, for BareSocket.
std::string upgrade_text(std::uint16_t port);

}  // namespace lightwalk::test
