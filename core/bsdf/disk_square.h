#pragma once
// The map between the unit disk and the unit square that keeps areas. Source: Shirley & Chiu, "A
// low distortion map between disk and square", Journal of Graphics Tools 2(3), 1997.
#include <array>
#include <cmath>
#include <cstddef>

#include "core/bsdf/angle_basis.h"

namespace lightwalk {

/// A point of the unit square; areas are projected solid angles over π.
struct UnitSquarePoint {
    double x = 0, y = 0;
};

/// Polynomial in q² for 4/π atan(q) / q, q from -1 to 1, interpolated at Chebyshev nodes; its error
/// is at most 4e-13, far below the cells of any tree.
inline constexpr std::array<double, 15> kOctant{
    0x1.45f306dc9c203p+0, -0x1.b2995e789f00fp-2,  0x1.04c26b0be24dfp-2, -0x1.748342ee40690p-3,
    0x1.21b87095b0b30p-3, -0x1.d9def3252ad1ep-4,  0x1.8fa631b6335c1p-4, -0x1.54e06f3eb91dbp-4,
    0x1.1ca852c894061p-4, -0x1.b976365789efbp-5,  0x1.28555be5eab51p-5, -0x1.3dc2e50f20598p-6,
    0x1.ef59673b8dea1p-8, -0x1.e98877f4587c0p-10, 0x1.c728d040b8ab7p-13};

[[nodiscard]] inline UnitSquarePoint disk_to_square(const ProjectedDirection& p) {
    const bool wide = std::abs(p.x) >= std::abs(p.y);
    const double far = wide ? p.x : p.y, near = wide ? p.y : p.x;
    const double q = far != 0 ? near / far : 0, q2 = q * q, q4 = q2 * q2, q8 = q4 * q4;
    // Four chains of a quarter of the length: what takes time is that steps wait for each other.
    const auto chain = [q8](std::size_t i) {
        return (kOctant[i + 8] * q8 + kOctant[i + 4]) * q8 + kOctant[i];
    };
    const double q24 = q8 * q8 * q8;
    const double even = (chain(0) + kOctant[12] * q24) + q4 * (chain(2) + kOctant[14] * q24);
    const double odd = (chain(1) + kOctant[13] * q24) + q4 * chain(3);
    const double a = std::copysign(std::sqrt(p.x * p.x + p.y * p.y), far);
    const double b = a * q * (even + odd * q2);
    return wide ? UnitSquarePoint{0.5 * (a + 1), 0.5 * (b + 1)}
                : UnitSquarePoint{0.5 * (b + 1), 0.5 * (a + 1)};
}

[[nodiscard]] inline ProjectedDirection square_to_disk(const UnitSquarePoint& p) {
    const double a = 2 * p.x - 1, b = 2 * p.y - 1;
    if (std::abs(a) >= std::abs(b)) {
        if (a == 0) return {};
        const double angle = (kPi / 4) * (b / a);
        return {a * std::cos(angle), a * std::sin(angle)};
    }
    const double angle = (kPi / 4) * (a / b);
    return {b * std::sin(angle), b * std::cos(angle)};
}

}  // namespace lightwalk
