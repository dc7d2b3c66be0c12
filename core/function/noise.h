#pragma once
// The noise functions of the language, with a cache of the last point: evaluations at neighbouring
// points, or of several functions at one point, share most of the work.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lightwalk {

/// The noise functions of the language; pure. noise3: K. Perlin, "Improving Noise", SIGGRAPH 2002;
/// fnoise3: fractal midpoint displacement, as Radiance does it.
[[nodiscard]] double noise3(double x, double y, double z);
[[nodiscard]] double fnoise3(double x, double y, double z);

}  // namespace lightwalk

namespace lightwalk::function {

/// Step of the backward differences that noise3x, noise3y and noise3z compute.
inline constexpr double kNoiseStep = .0005;

/// The last point and noise3 there.
struct NoiseMemory {
    std::array<double, 3> point{};
    double value = 0;
};
[[nodiscard]] inline double noise3(double x, double y, double z, NoiseMemory& memory) {
    const std::array<double, 3> p{x, y, z};
    // Compared by bits: -0 and 0 are different points.
    using Bits = std::array<std::uint64_t, 3>;
    if (std::bit_cast<Bits>(p) != std::bit_cast<Bits>(memory.point)) {
        memory = {p, lightwalk::noise3(x, y, z)};
    }
    return memory.value;
}
/// (noise3(p) - noise3(p - step along axis)) / step.
[[nodiscard]] double noise3_difference(int axis, double x, double y, double z, NoiseMemory& memory);

/// The path by which fnoise3 last descended to a point: the cell, and for each halving the octant
/// and the values at the corners of the enclosing cube.
struct FractalMemory {
    static constexpr std::size_t kLevels = 10;
    std::array<std::int64_t, 3> cell{std::numeric_limits<std::int64_t>::min(), 0, 0};
    std::array<std::uint32_t, kLevels> octants{};
    std::array<std::array<double, 8>, kLevels + 1> corners{};
};
[[nodiscard]] double fnoise3(double x, double y, double z, FractalMemory& memory);

}  // namespace lightwalk::function
