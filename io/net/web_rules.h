#pragma once
// Which requests the web server accepts: decided before any work is done for them. The rules are in
// io/net/README.md.
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace lightwalk {

/// The parts of a request that the decision depends on.
struct WebRequest {
    bool get = true;       ///< its method is GET
    bool upgrade = false;  ///< it asks for a WebSocket
    std::string_view target, host;
    std::optional<std::string_view> origin;
    std::string_view fetch_site;  ///< header Sec-Fetch-Site: which site's page asks
};

enum class WebDoor { refused, asset, walk, save };

/// The decision about a request.
struct WebVerdict {
    WebDoor door = WebDoor::refused;
    std::string path;     ///< the path of the target, without the query
    unsigned status = 0;  ///< HTTP status, when refused
    std::string text;     ///< the reason, when refused
};

/// Decide about a request. With an empty token none is demanded, and the Host header must name this
/// machine. Whether an asset of that path exists is not checked here.
[[nodiscard]] WebVerdict judge_request(const WebRequest& request, std::string_view token);

/// Whether two secrets are equal, in a time that depends on their lengths only (against timing
/// attacks).
[[nodiscard]] bool same_secret(std::string_view given, std::string_view expected);
/// A secret of 128 bits, as 32 hex digits.
[[nodiscard]] std::string make_token();
/// Whether a Host header, with or without port, is "localhost" or a loopback address.
[[nodiscard]] bool is_loopback(std::string_view host);

/// A rate limit by a token bucket: `per_second` events on average, and up to `stock` at once.
class RateLimit {
  public:
    using Time = std::chrono::steady_clock::time_point;
    RateLimit(double per_second, double stock)
        : per_second_(per_second), most_(stock), stock_(stock) {}
    /// Remove a token; false when there is none left. `now` must not decrease.
    [[nodiscard]] bool try_acquire(Time now);

  private:
    double per_second_, most_, stock_;
    std::optional<Time> last_;
};

}  // namespace lightwalk
