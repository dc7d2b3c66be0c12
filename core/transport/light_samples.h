#pragma once
// Light samples as a surface is asked about them: a structure of arrays.
#include <cstddef>
#include <span>
#include <utility>

#include "core/math/function_ref.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// SIMD width: this many numbers of double precision are computed at once.
inline constexpr std::size_t kSimdWidth = 4;

/// A number of elements, rounded up to a multiple of the SIMD width, so that no loop has elements
/// left over: most points see few lights.
[[nodiscard]] constexpr std::size_t round_up_to_simd_width(std::size_t count) {
    return (count + kSimdWidth - 1) / kSimdWidth * kSimdWidth;
}

/// Lights as one point sees them, as a structure of arrays: unit directions wi, away from the
/// surface, and solid angles [sr]. Each array may be read up to
/// round up to simd width(count), where anything may stand.
struct LightSamples {
    const double *x, *y, *z, *solid_angle;
    std::size_t count;

    [[nodiscard]] Vec3 direction(std::size_t i) const { return {x[i], y[i], z[i]}; }
    /// One of them alone.
    [[nodiscard]] LightSamples single(std::size_t i) const {
        return {x + i, y + i, z + i, solid_angle + i, 1};
    }
};

/// Writes to k[i] what a surface sends towards the eye per unit radiance of light i: f cosθ ω.
/// Zero for lights on a side that the surface does not see. k.size() >= lights.count.
using DirectCoefficient = FunctionRef<void(const LightSamples& lights, std::span<Rgb> k)>;

/// A coefficient that looks at one light after the other.
/// @param of  Rgb(const Vec3& wi, double omega)
template <class F>
[[nodiscard]] auto one_by_one(F of) {
    return [of = std::move(of)](const LightSamples& lights, std::span<Rgb> k) {
        for (std::size_t i = 0; i < lights.count; ++i)
            k[i] = of(lights.direction(i), lights.solid_angle[i]);
    };
}

}  // namespace lightwalk
