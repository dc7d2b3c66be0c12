#pragma once
// Importance sampling of lights: a few of many samples are chosen, in proportion to what they
// bring, and stand for all.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// A sample that was chosen.
struct LightChoice {
    std::uint32_t which = 0;  ///< index into the sizes
    float scale = 1;          ///< 1 / pmf: the inverse of the probability of being chosen
};

/// Choose about `wanted` light samples of many, or all that are not 0 where these are fewer,
/// without bias: the mean of what the chosen bring, each times its scale, is what all bring.
/// Samples that are larger than an even share of the rest are always chosen; the probability of the
/// others is proportional to their size, but no scale is above 1000. Source: Madow, "On the theory
/// of systematic sampling, II", Annals of Mathematical Statistics 20, 1949.
/// @param sizes   estimates of what each sample brings; not negative. All are chosen where their
///                sum is not finite.
/// @param wanted  at least 1
/// @param random  uniform in [0, 1)
/// @param chosen  out: the choices, in ascending order of `which`
void choose_lights(std::span<const float> sizes, std::size_t wanted, double random,
                   std::vector<LightChoice>& chosen);

}  // namespace lightwalk
