#include "io/net/web_rules.h"

#include <algorithm>
#include <array>
#include <random>

namespace lightwalk {
namespace {

/// The value of `name` in "a=1&b=2"; nothing is escaped in what we look for.
std::string_view query_value(std::string_view query, std::string_view name) {
    while (!query.empty()) {
        const std::size_t end = std::min(query.find('&'), query.size());
        const std::string_view pair = query.substr(0, end);
        query.remove_prefix(std::min(end + 1, query.size()));
        if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=') {
            return pair.substr(name.size() + 1);
        }
    }
    return {};
}

/// "http://host:port" -> "host:port"; nothing for anything else, "null" included.
std::optional<std::string_view> host_of(std::string_view origin) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (origin.starts_with(scheme)) return origin.substr(scheme.size());
    }
    return std::nullopt;
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

/// The host without its port.
std::string_view without_port(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, std::min(host.find(']'), host.size() - 1) + 1);
    return host.substr(0, host.find(':'));
}

/// 127.a.b.c
bool is_loopback_number(std::string_view name) {
    return name.starts_with("127.") && std::count(name.begin(), name.end(), '.') == 3 &&
           name.find_first_not_of("0123456789.") == std::string_view::npos;
}

WebVerdict refusal(unsigned status, std::string text) {
    return {WebDoor::refused, {}, status, std::move(text)};
}

}  // namespace

WebVerdict judge_request(const WebRequest& request, std::string_view token) {
    if (!request.get) return refusal(405, "only GET is supported");
    const std::size_t end = std::min(request.target.find('?'), request.target.size());
    const std::string_view path = request.target.substr(0, end);
    const bool walk = path == "/walk", save = path.starts_with("/save/");
    if (token.empty() && !is_loopback(request.host)) {
        return refusal(421, "this server answers to localhost and loopback addresses only");
    }
    if (!token.empty() && (walk || save || path == "/")) {
        const std::string_view query = request.target.substr(end);
        const std::string_view given =
            query_value(query.substr(std::min<std::size_t>(1, query.size())), "token");
        if (!same_secret(given, token)) {
            return refusal(403, "the token is missing: use the address that lightwalk printed");
        }
    }
    if (walk) {
        const std::optional<std::string_view> asks =
            request.origin ? host_of(*request.origin) : request.host;
        if (!asks || !same_name(*asks, request.host)) {
            return refusal(403, "requests from pages of other hosts are refused");
        }
        if (!request.upgrade) return refusal(426, "this path is for WebSockets only");
    }
    if (save && request.fetch_site == "cross-site") {
        return refusal(403, "requests from pages of other sites are refused");
    }
    return {walk ? WebDoor::walk : save ? WebDoor::save : WebDoor::asset, std::string(path), 0, {}};
}

bool same_secret(std::string_view given, std::string_view expected) {
    if (given.size() != expected.size()) return false;
    volatile unsigned char difference = 0;  // or the compiler could leave early
    for (std::size_t i = 0; i < given.size(); ++i) {
        difference =
            static_cast<unsigned char>(difference | (static_cast<unsigned char>(given[i]) ^
                                                     static_cast<unsigned char>(expected[i])));
    }
    return difference == 0;
}

std::string make_token() {
    std::random_device random;  // random numbers of the kernel or the processor
    std::string token;
    for (int word = 0; word < 4; ++word) {
        const unsigned bits = random();
        for (int shift = 28; shift >= 0; shift -= 4)
            token += "0123456789abcdef"[(bits >> shift) & 15];
    }
    return token;
}

bool is_loopback(std::string_view host) {
    if (host.empty()) return false;
    const std::string_view name = without_port(host);
    return same_name(name, "localhost") || name == "[::1]" || host == "::1" ||
           is_loopback_number(name);
}

bool RateLimit::try_acquire(Time now) {
    if (last_) {
        const std::chrono::duration<double> passed = now - *last_;
        stock_ = std::min(most_, stock_ + per_second_ * passed.count());
    }
    last_ = now;
    if (stock_ < 1) return false;
    stock_ -= 1;
    return true;
}

}  // namespace lightwalk
