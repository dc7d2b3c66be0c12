// The shared ambient cache: the serial one's answers, and nothing lost or torn with many threads.
#include "parallel/concurrent_cache.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "core/math/direction_code.h"
#include "core/math/random.h"
#include "tests/one_thread.h"
#include "tests/tolerance.h"

namespace lightwalk {
using namespace test;

namespace {

const AmbientLimits kLimits = ambient_limits({-1, -1, -1}, 2, 0.1, 64);
constexpr auto kNoLeak = [](const Vec3&) { return false; };

Vec3 random_point(RandomStream& random) {
    return {2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
}

AmbientRecord random_record(RandomStream& random) {
    AmbientRecord r;
    const Vec3 p = random_point(random), n = normalize(random_point(random));
    r.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    r.normal = encode_direction(n);
    r.axis = encode_direction(perpendicular(n));
    r.radius[0] = static_cast<float>(kLimits.least_radius * (1 + 20 * random.next()));
    r.radius[1] = r.radius[0] * static_cast<float>(1 + random.next());
    r.translation = {static_cast<float>(random.next() - 0.5),
                     static_cast<float>(random.next() - 0.5)};
    r.value = {static_cast<float>(random.next()), static_cast<float>(random.next()), 0.5f};
    r.level = static_cast<std::uint8_t>(3 * random.next());
    r.weight = static_cast<float>(std::pow(0.5, r.level));
    return r;
}

AmbientQuery random_query(RandomStream& random) {
    const Vec3 n = normalize(random_point(random));
    const int level = static_cast<int>(3 * random.next());
    return {random_point(random), n, n, level, std::pow(0.5, level)};
}

/// A record that only its own place finds, with content that tells who made it.
AmbientRecord numbered_record(std::uint32_t id) {
    AmbientRecord r;
    const auto axis = [id](unsigned shift) {
        return static_cast<float>(-0.99 + 1.98 / 1024 * ((id >> shift) & 1023));
    };
    r.position = {axis(0), axis(10), 0};
    r.normal = encode_direction({0, 0, 1});
    r.axis = encode_direction({1, 0, 0});
    r.radius = {0.005f, 0.005f};
    r.value = {static_cast<float>(id), static_cast<float>(2 * id), static_cast<float>(3 * id)};
    return r;
}

}  // namespace

TEST_CASE("the concurrent cache finds what the serial one finds" * one_thread) {
    RandomStream random(17);
    SerialCache serial(kLimits);
    ConcurrentCache shared(kLimits);
    for (int i = 0; i < 20000; ++i) {
        const AmbientRecord record = random_record(random);
        serial.insert(record);
        shared.insert(record);
    }
    CHECK(shared.size() == serial.size());
    CHECK(shared.log_mean().count == serial.log_mean().count);
    CHECK(shared.log_mean().sum == rounded(serial.log_mean().sum));
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const AmbientQuery query = random_query(random);
        const AmbientSum a = serial.lookup(query, kNoLeak), b = shared.lookup(query, kNoLeak);
        REQUIRE(b.weight == rounded(a.weight));
        REQUIRE(b.sum[0] == rounded(a.sum[0]));
        found += a.weight > kEpsilon ? 1 : 0;
    }
    CHECK(found > 100);
}

TEST_CASE("eight threads: every value that was stored is found, whole, and once") {
    constexpr std::uint32_t kThreads = 8;
    // As many lookups as insertions: a million in all. ThreadSanitizer orders what threads do, and
    // needs no luck to find them at odds.
#if defined(__SANITIZE_THREAD__)
    constexpr std::uint32_t kEach = 12500;
#else
    constexpr std::uint32_t kEach = 62500;
#endif
    ConcurrentCache cache(ambient_limits({-1, -1, -1}, 2, 0.1, 2000));
    std::atomic<int> torn{0}, lost{0};
    const auto check = [&](std::uint32_t id, bool must) {
        const AmbientRecord r = numbered_record(id);
        const Vec3 p{static_cast<double>(r.position[0]), static_cast<double>(r.position[1]), 0};
        const AmbientSum sum = cache.lookup({p, {0, 0, 1}, {0, 0, 1}, 0, 1}, kNoLeak);
        if (sum.weight <= kEpsilon) {
            lost += must ? 1 : 0;
            return;
        }
        // Values are floats, summed in doubles and divided by a weight that is a float.
        const double value = sum.sum[0] / sum.weight;
        const bool whole =
            std::abs(value - id) <= kFloatRounding * (1 + id) &&
            std::abs(sum.sum[1] / sum.weight - 2 * value) <= kFloatRounding * (1 + id) &&
            std::abs(sum.sum[2] / sum.weight - 3 * value) <= kFloatRounding * (1 + id) &&
            sum.weight < 1.01;
        torn += whole ? 0 : 1;
    };
    std::vector<std::thread> threads;
    for (std::uint32_t t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            RandomStream random(t + 1);
            for (std::uint32_t i = 0; i < kEach; ++i) {
                const std::uint32_t id = i * kThreads + t;  // neighbours go to different threads
                cache.insert(numbered_record(id));
                check(id, true);
                check(static_cast<std::uint32_t>(random.next() * kThreads * kEach), false);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(torn == 0);
    CHECK(lost == 0);
    CHECK(cache.size() == kThreads * kEach);
    for (std::uint32_t id = 0; id < kThreads * kEach; id += 7) check(id, true);
    CHECK(torn == 0);
    CHECK(lost == 0);
    CHECK(cache.log_mean().count == kThreads * kEach - 1);  // number 0 is black
}

TEST_CASE("values on a surface take at most 160 bytes each, everything counted" * one_thread) {
    RandomStream random(3);
    ConcurrentCache cache(kLimits);
    int count = 0;
    for (const int goal : {3000, 10000, 100000}) {
        CAPTURE(goal);
        for (; count < goal; ++count) {
            AmbientRecord record = random_record(random);
            record.position[2] = 0;
            cache.insert(record);
        }
        CHECK(static_cast<double>(cache.memory_bytes()) / goal <= 160);
    }
}

}  // namespace lightwalk
