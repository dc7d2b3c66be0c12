#include "core/math/sequence_2d.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

namespace {

SequenceSeeds seeds_of(std::uint64_t number) {
    const std::uint64_t a = mix_bits(number), b = mix_bits(a);
    return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32),
            static_cast<std::uint32_t>(b)};
}

/// Whether 2^k points from `first` on lie one in each box, for all ways to halve a square k times.
bool is_net(std::uint32_t first, int k, const SequenceSeeds& seeds) {
    for (int columns = 0; columns <= k; ++columns) {
        std::set<std::pair<int, int>> boxes;
        for (std::uint32_t i = 0; i < (1U << k); ++i) {
            const SequencePoint p = sequence_point(reverse_bits(first + i), seeds);
            boxes.emplace(static_cast<int>(p.first * (1 << columns)),
                          static_cast<int>(p.second * (1 << (k - columns))));
        }
        if (boxes.size() != (1U << k)) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("bits in reverse order: the lowest becomes the highest, and twice is as before") {
    CHECK(reverse_bits(1) == 0x80000000U);
    CHECK(reverse_bits(0x0000f006U) == 0x600f0000U);
    for (std::uint32_t v : {0x12345678U, 0xdeadbeefU, 0xffffffffU})
        CHECK(reverse_bits(reverse_bits(v)) == v);
}

TEST_CASE("second digits are sums over binomial coefficients, modulo 2") {
    std::vector<std::vector<int>> binomial(32, std::vector<int>(32, 0));
    for (std::size_t n = 0; n < 32; ++n) {
        binomial[n][0] = 1;
        for (std::size_t k = 1; k <= n; ++k)
            binomial[n][k] = (binomial[n - 1][k - 1] + binomial[n - 1][k]) % 2;
    }
    for (std::uint32_t index : {1U, 2U, 3U, 0x80000000U, 0x12345678U, 0xdeadbeefU}) {
        for (std::size_t j = 0; j < 32; ++j) {
            int sum = 0;
            for (std::size_t k = j; k < 32; ++k)
                sum += binomial[k][j] * static_cast<int>((index >> k) & 1U);
            CHECK(static_cast<int>((second_digits(index) >> j) & 1U) == sum % 2);
        }
    }
}

TEST_CASE("scrambling turns a digit by those before it alone, and is one to one") {
    for (const std::uint32_t seed : {7U, 0x9e3779b9U, 0xfedcba98U}) {
        for (int bit = 0; bit < 32; ++bit) {
            const std::uint32_t below = (1U << bit) - 1, a = 0x5a5a1234U, b = a ^ (1U << bit);
            const std::uint32_t changed = scramble_upwards(a, seed) ^ scramble_upwards(b, seed);
            CHECK((changed & below) == 0);
            CHECK((changed & (1U << bit)) != 0);
        }
    }
}

TEST_CASE("2^k points that begin at a multiple of it lie one in each box of the square") {
    for (std::uint64_t number = 0; number < 20; ++number) {
        CAPTURE(number);
        const SequenceSeeds seeds = seeds_of(number);
        for (int k = 0; k <= 8; ++k) {
            CHECK(is_net(0, k, seeds));
            CHECK(is_net(5U << k, k, seeds));
            CHECK(is_net(0xfedU << 18 << k, k, seeds));
        }
    }
    CHECK_FALSE(is_net(1, 4, seeds_of(0)));  // the test can tell
}

TEST_CASE("squares of pixels are pieces of Morton's curve") {
    CHECK(morton_index(0, 0) == 0);
    CHECK(morton_index(1, 0) == 1);
    CHECK(morton_index(0, 1) == 2);
    CHECK(morton_index(0xffff, 0xffff) == 0xffffffffU);
    for (const std::uint32_t side : {2U, 4U, 16U}) {
        std::set<std::uint32_t> places;
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; ++x)
                places.insert(morton_index(5 * side + x, 3 * side + y));
        }
        CHECK(places.size() == side * side);
        CHECK(*places.rbegin() - *places.begin() == side * side - 1);
    }
}
