#pragma once
// How many of a point's light candidates are tested for shadows, brightest first.
// Source: Ward, "Adaptive shadow testing for ray tracing", Eurographics Workshop on Rendering 1991.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/math/vec3.h"

namespace lightwalk {

/// What the shadow tests of a point have found so far.
struct ShadowTally {
    double hits = 0;       ///< candidates that got through
    double expected = 0;   ///< sum of the hit rates of the sources of all tested candidates
    float brightness = 0;  ///< brightness of the point's radiance so far

    /// Visibility at this point relative to what its tested sources have in the mean.
    [[nodiscard]] double factor() const { return expected > kEpsilon ? hits / expected : 0.5; }
};

inline constexpr std::size_t kFirstBlock = 4;   ///< candidates that are always tested
inline constexpr std::size_t kNextBlocks = 16;  ///< candidates per later block
/// A point with up to this many candidates tests all of them when some have patterns: to sort them,
/// all patterns would have to be evaluated, which costs more than a shadow test.
inline constexpr std::size_t kFewPatterned = kFirstBlock + kNextBlocks;

/// How many of the next candidates decide together whether testing goes on: count to the power of
/// `certainty`.
/// @param certainty  -dc
[[nodiscard]] inline std::size_t look_ahead(std::size_t count, double certainty) {
    const auto all = static_cast<double>(count);
    return static_cast<std::size_t>(std::min(all, std::floor(std::pow(all, certainty) + 0.5)));
}

/// The end of the block of candidates that begins with `first`: `first` itself when what is left
/// cannot matter.
/// @param remaining_sums  brightness[i] + brightness[i+1] + ... for each candidate, then 0
/// @param ahead           what look_ahead() returns
/// @param threshold       -dt over the ray's weight: ignore what is less than this share of the
///                        radiance
/// @param so_far          brightness of the point's radiance from the candidates before `first`
[[nodiscard]] inline std::size_t next_block(std::span<const float> remaining_sums,
                                            std::size_t ahead, double threshold, std::size_t first,
                                            float so_far) {
    const std::size_t n = remaining_sums.size() - 1;
    if (first >= n) return first;
    const float rest = first + ahead >= n ? remaining_sums[first]
                                          : remaining_sums[first] - remaining_sums[first + ahead];
    if (first > 0 && static_cast<double>(rest) < threshold * static_cast<double>(so_far))
        return first;
    return std::min(n, first + (first == 0 ? kFirstBlock : kNextBlocks));
}

/// Test candidates block by block until the next ones cannot matter. Parameters as next_block() and
/// look_ahead() have them.
/// @param test  test(first, last): tests the candidates [first, last) and brings the tally up to
///              date
/// @return      how many candidates were tested
template <class Test>
std::size_t test_brightest(std::span<const float> remaining_sums, double certainty,
                           double threshold, const ShadowTally& tally, Test&& test) {
    const std::size_t ahead = look_ahead(remaining_sums.size() - 1, certainty);
    for (std::size_t first = 0;;) {
        const std::size_t last =
            next_block(remaining_sums, ahead, threshold, first, tally.brightness);
        if (last == first) return first;
        test(first, last);
        first = last;
    }
}

}  // namespace lightwalk
