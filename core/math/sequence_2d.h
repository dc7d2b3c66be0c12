#pragma once
// A (0,2)-sequence: points of the unit square of which the first 2^k, and the next, and so on, lie
// one in each of the 2^k boxes that halving the square k times makes, whatever sides are halved.
#include <cstdint>

namespace lightwalk {

/// The bits in reverse order.
[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t v) {
    v = ((v >> 1) & 0x55555555U) | ((v & 0x55555555U) << 1);
    v = ((v >> 2) & 0x33333333U) | ((v & 0x33333333U) << 2);
    v = ((v >> 4) & 0x0f0f0f0fU) | ((v & 0x0f0f0f0fU) << 4);
    return __builtin_bswap32(v);
}

/// Nested uniform scrambling (Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) of
/// a binary fraction whose first digit is the lowest bit: whether a bit is turned depends on those
/// below it alone. Source: Laine & Karras, "Stratified sampling for stochastic transparency", EGSR
/// 2011, section 3.1; Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020; the
/// constants are those of N. Vegdahl, "Building a better LK hash", 2021.
[[nodiscard]] constexpr std::uint32_t scramble_upwards(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeaU;
    v += seed;
    v *= (seed >> 16) | 1U;
    v ^= v * 0x05526c56U;
    v ^= v * 0x53a22864U;
    return v;
}

/// The second coordinate of Sobol's sequence for the index of the first, van der Corput's: bit j of
/// the result (the lowest is the first digit) is the sum of the index's bits k with odd binomial
/// coefficient (k over j), i.e. (Lucas) where k has all bits of j. Source: Sobol', "On the
/// distribution of points in a cube and the approximate evaluation of integrals", 1967.
[[nodiscard]] constexpr std::uint32_t second_digits(std::uint32_t index) {
    index ^= index >> 16;
    index ^= (index & 0xff00ff00U) >> 8;
    index ^= (index & 0xf0f0f0f0U) >> 4;
    index ^= (index & 0xccccccccU) >> 2;
    index ^= (index & 0xaaaaaaaaU) >> 1;
    return index;
}

/// What makes one of the scrambled sequences.
struct SequenceSeeds {
    std::uint32_t order, first, second;
};

/// A point of the unit square [0, 1)²; multiples of 2^-32.
struct SequencePoint {
    double first, second;
};

/// The point at `index` of the sequence in a random order, in which the first 2^k, the next, and so
/// on, are still those of the sequence, all scrambled: a single point is uniform, and sequences of
/// different seeds are independent of each other. Source: Burley (above), section 4: padding by
/// shuffled sequences.
/// @param reversed_index  reverse_bits(index)
[[nodiscard]] constexpr SequencePoint sequence_point(std::uint32_t reversed_index,
                                                     const SequenceSeeds& seeds) {
    const std::uint32_t index = reverse_bits(scramble_upwards(reversed_index, seeds.order));
    const std::uint32_t first = scramble_upwards(index, seeds.first);
    const std::uint32_t second = scramble_upwards(second_digits(index), seeds.second);
    return {static_cast<double>(reverse_bits(first)) * 0x1p-32,
            static_cast<double>(reverse_bits(second)) * 0x1p-32};
}

/// The place of (x, y) along Morton's curve, for coordinates below 2^16: any square of 2^k numbers
/// a side, with corners at multiples of these, is one piece of it.
[[nodiscard]] constexpr std::uint32_t morton_index(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint32_t v) {
        v = (v | (v << 8)) & 0x00ff00ffU;
        v = (v | (v << 4)) & 0x0f0f0f0fU;
        v = (v | (v << 2)) & 0x33333333U;
        return (v | (v << 1)) & 0x55555555U;
    };
    return spread(x & 0xffffU) | (spread(y & 0xffffU) << 1);
}

}  // namespace lightwalk
