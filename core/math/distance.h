#pragma once
// Distances along a ray, and what stands for "none": the aft clipping plane's and that of nothing.
#include "core/math/vec3.h"

namespace lightwalk {

/// Whether an aft clipping distance cuts anything off: one of at most kEpsilon stands for none.
[[nodiscard]] constexpr bool is_limited(double limit) {
    return limit > kEpsilon;
}

/// How far a ray with this aft clipping distance can meet surfaces [m]. A surface that coincides
/// with the clipping plane, beyond it or short of it, is not met, so that a ray from point to point
/// ends before the surface that holds the second one. Coincident means up to kEpsilon apart; a
/// little more counts, so that rounding does not decide about surfaces that are kEpsilon apart.
[[nodiscard]] constexpr double farthest_hit(double limit) {
    return is_limited(limit) ? limit - 1.05 * kEpsilon : kHuge;
}

/// What is left of an aft clipping distance behind a surface that lies `t` away; 0 (none) stays 0.
[[nodiscard]] constexpr double limit_beyond(double limit, double t) {
    return is_limited(limit) ? limit - t : 0;
}

/// Whether a hit's distance says that nothing was hit, or a source at infinity: such hits have
/// t = kHuge, but for rounding where distances are added up.
[[nodiscard]] constexpr bool is_infinite(double t) {
    return t >= 0.99 * kHuge;
}

}  // namespace lightwalk
