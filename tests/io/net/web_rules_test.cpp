#include "io/net/web_rules.h"

#include <doctest/doctest.h>

#include <set>

using namespace lightwalk;

namespace {

WebRequest to_walk(std::string_view host, std::optional<std::string_view> origin) {
    return {true, true, "/walk", host, origin, {}};
}

unsigned status(const WebRequest& request, std::string_view token = "") {
    return judge_request(request, token).status;
}

}  // namespace

TEST_CASE("web rules: requests go to the walk, to pictures or to assets by their path") {
    const auto door = [](std::string_view target, bool upgrade) {
        return judge_request({true, upgrade, target, "localhost:8080", {}, {}}, "").door;
    };
    CHECK(door("/walk", true) == WebDoor::walk);
    CHECK(door("/walk?x", true) == WebDoor::walk);
    CHECK(door("/walk", false) == WebDoor::refused);
    CHECK(door("/save/picture.hdr", false) == WebDoor::save);
    CHECK(door("/", false) == WebDoor::asset);
    CHECK(door("/walker", false) == WebDoor::asset);
    CHECK(judge_request({true, false, "/a?b?c", "localhost", {}, {}}, "").path == "/a");
    CHECK(judge_request({true, false, "", "localhost", {}, {}}, "").path.empty());
}

TEST_CASE("web rules: the token is one of the values behind the question mark") {
    const auto with = [](std::string_view target) {
        return status({true, false, target, "house.example", {}, {}}, "secret");
    };
    CHECK(with("/?token=secret") == 0);
    CHECK(with("/?a=b&token=secret&c") == 0);
    for (const char* target :
         {"/", "/?", "/?token", "/?token=", "/?token=Secret", "/?token=secrets", "/?token=secre",
          "/?atoken=secret", "/?a&&b=token=secret"}) {
        CAPTURE(target);
        CHECK(with(target) == 403);
    }
    CHECK(with("/page/walk.css") == 0);
}

TEST_CASE("web rules: an origin is the host that is asked, or nothing") {
    CHECK(status(to_walk("localhost:8080", std::nullopt)) == 0);
    CHECK(status(to_walk("localhost:8080", "http://localhost:8080")) == 0);
    CHECK(status(to_walk("LocalHost:8080", "http://localhost:8080")) == 0);
    CHECK(status(to_walk("[::1]:8080", "http://[::1]:8080")) == 0);
    for (const char* origin :
         {"", "null", "http://", "localhost:8080", "http://localhost", "http://localhost:80801",
          "http://localhost:8080.evil.example", "ftp://localhost:8080"}) {
        CAPTURE(origin);
        CHECK(status(to_walk("localhost:8080", origin)) == 403);
    }
}

TEST_CASE("web rules: without a token only names that always mean this machine are answered") {
    for (const char* host :
         {"localhost", "localhost:1", "127.0.0.1:8080", "127.1.2.3", "[::1]:80", "[::1]", "::1"}) {
        CAPTURE(host);
        CHECK(is_loopback(host));
        CHECK(status({true, false, "/", host, {}, {}}) == 0);
    }
    for (const char* host : {"", "127.0.0.1.evil.example", "localhost.evil.example", "128.0.0.1",
                             "127.evil.0.0", "[::2]", "[", "0.0.0.0", "192.168.1.1"}) {
        CAPTURE(host);
        CHECK_FALSE(is_loopback(host));
        CHECK(status({true, false, "/", host, {}, {}}) == 421);
    }
}

TEST_CASE("web rules: secrets are the same when every byte is") {
    CHECK(same_secret("", ""));
    CHECK(same_secret("abc", "abc"));
    CHECK_FALSE(same_secret("abd", "abc"));
    CHECK_FALSE(same_secret("bbc", "abc"));
    CHECK_FALSE(same_secret("abcd", "abc"));
    CHECK_FALSE(same_secret("", "abc"));
}

TEST_CASE("web rules: tokens are 32 hex digits, another each time") {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) {
        const std::string token = make_token();
        CHECK(token.size() == 32);
        CHECK(token.find_first_not_of("0123456789abcdef") == std::string::npos);
        tokens.insert(token);
    }
    CHECK(tokens.size() == 100);
}

TEST_CASE("web rules: a rate limit gives its stock at once, then so many a second") {
    using std::chrono::milliseconds;
    RateLimit limit(10, 3);
    RateLimit::Time now{};
    for (int i = 0; i < 3; ++i) CHECK(limit.try_acquire(now));
    CHECK_FALSE(limit.try_acquire(now));
    CHECK_FALSE(limit.try_acquire(now += milliseconds(99)));
    CHECK(limit.try_acquire(now += milliseconds(2)));
    CHECK_FALSE(limit.try_acquire(now));
    int taken = 0;
    for (int i = 0; i < 1000; ++i) taken += limit.try_acquire(now += milliseconds(10)) ? 1 : 0;
    CHECK((taken >= 99 && taken <= 101));  // 10 s
    now += std::chrono::hours(1);
    for (int i = 0; i < 3; ++i) CHECK(limit.try_acquire(now));
    CHECK_FALSE(limit.try_acquire(now));
}
