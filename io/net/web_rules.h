#pragma once
// What a web server lets in: the decisions about a request, before any work is done for it. The
// rules are told in README.md beside this.
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace lightwalk {

/// The parts of a request that decide.
struct WebRequest {
    bool get = true;       ///< its method is GET
    bool upgrade = false;  ///< it asks for a WebSocket
    std::string_view target, host;
    std::optional<std::string_view> origin;
    std::string_view fetch_site;  ///< Sec-Fetch-Site, by which browsers say who asks
};

enum class WebDoor { refused, asset, walk, save };

/// Where a request may go.
struct WebVerdict {
    WebDoor door = WebDoor::refused;
    std::string path;     ///< of the target, without what follows '?'
    unsigned status = 0;  ///< HTTP status, when refused
    std::string text;     ///< why, when refused
};

/// Judge a request. An empty token: none is demanded, and the host must be this machine's own.
/// Whether there is such an asset is the server's question.
[[nodiscard]] WebVerdict judge_request(const WebRequest& request, std::string_view token);

/// Whether two secrets are the same, in a time that tells no more than their lengths.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view expected);
/// A secret of 128 bits, as 32 hex digits.
[[nodiscard]] std::string make_token();
/// Whether a Host header, with or without port, can only mean this machine: "localhost" or a
/// loopback address.
[[nodiscard]] bool is_loopback(std::string_view host);

/// So many a second on average, and a stock of them to spend at once (a token bucket).
class RateLimit {
  public:
    using Time = std::chrono::steady_clock::time_point;
    RateLimit(double per_second, double stock)
        : per_second_(per_second), most_(stock), stock_(stock) {}
    /// Take one; false when there is none left. Times must not fall.
    [[nodiscard]] bool try_acquire(Time now);

  private:
    double per_second_, most_, stock_;
    std::optional<Time> last_;
};

}  // namespace lightwalk
