// Claims on ambient values that are being computed.
#include "parallel/claim_table.h"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

namespace lightwalk {
namespace {

using namespace std::chrono_literals;

AmbientQuery query_at(const Vec3& position, int level = 0, const Vec3& normal = {0, 0, 1}) {
    return {position, normal, normal, level, 1};
}

/// Teaches the table that values take about this long.
void take(ClaimTable& table, std::chrono::milliseconds time) {
    for (int i = 0; i < 40; ++i) {
        const AmbientClaim claim = table.claim(query_at({100, 0, 0}));
        std::this_thread::sleep_for(time);
        table.release(claim);
    }
}

}  // namespace

TEST_CASE("a claim waits for one close by, at the same level and on the same side") {
    ClaimTable table(0.5);
    const AmbientClaim first = table.claim(query_at({0, 0, 0}));
    CHECK_FALSE(first.waited);
    for (const AmbientQuery& far :
         {query_at({0.6, 0, 0}), query_at({0, 0, 0}, 1), query_at({0, 0, 0}, 0, {0, 0, -1})}) {
        const AmbientClaim other = table.claim(far);
        CHECK_FALSE(other.waited);
        table.release(other);
    }
    const AmbientClaim near = table.claim(query_at({0.4, 0, 0}));
    CHECK(near.waited);
    CHECK(table.open() == 2);
    table.release(near);
    table.release(first);
    table.release(first);  // twice does no harm
    CHECK(table.open() == 0);
}

TEST_CASE("waiting ends though the value never comes") {
    ClaimTable table(0.5);
    take(table, 1ms);
    const AmbientClaim first = table.claim(query_at({0, 0, 0}));
    const AmbientClaim second =
        table.claim(query_at({0, 0, 0}));  // the same thread: a hang without a bound
    CHECK(second.waited);
    table.release(second);
    table.release(first);
}

TEST_CASE("claims of many threads leave nothing behind") {
    ClaimTable table(0.05);
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
        threads.emplace_back([&table, t] {
            for (int i = 0; i < 2000; ++i) {
                const double x = 0.01 * ((i * 7 + t) % 50);
                const AmbientClaim outer = table.claim(query_at({x, 0, 0}, 0));
                const AmbientClaim inner = table.claim(query_at({x, 0, 0}, 1));
                table.release(inner);
                table.release(outer);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(table.open() == 0);
}

}  // namespace lightwalk
