#pragma once
// What a surface is asked about lights.
#include <cstddef>
#include <span>
#include <utility>

#include "core/math/function_ref.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// So many numbers at a time are computed side by side.
inline constexpr std::size_t kSimdWidth = 4;

/// A number of elements rounded up, so that no loop has elements left over: most points see few
/// lights.
[[nodiscard]] constexpr std::size_t round_up_to_simd_width(std::size_t count) {
    return (count + kSimdWidth - 1) / kSimdWidth * kSimdWidth;
}

/// Lights as one point sees them, an array a number, so that they are looked at side by side: unit
/// directions away from the surface, and solid angles [sr]. Each may be read up to
/// round up to simd width(count), where anything may stand.
struct LightSamples {
    const double *x, *y, *z, *solid_angle;
    std::size_t count;

    [[nodiscard]] Vec3 direction(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// What a surface sends towards the eye per unit radiance of each light, f cosθ ω, is written to
/// `k`, which has room for so many. Zero for lights on a side that the surface does not see.
using DirectCoefficient = FunctionRef<void(const LightSamples& lights, std::span<Rgb> k)>;

/// A coefficient that looks at one light after the other.
/// @param of  Rgb(const Vec3& l, double omega)
template <class F>
[[nodiscard]] auto one_by_one(F of) {
    return [of = std::move(of)](const LightSamples& lights, std::span<Rgb> k) {
        for (std::size_t i = 0; i < lights.count; ++i)
            k[i] = of(lights.direction(i), lights.solid_angle[i]);
    };
}

}  // namespace lightwalk
