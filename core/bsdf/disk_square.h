#pragma once
// The map between the unit disk and the unit square that keeps areas. Source: Shirley & Chiu, "A
// low distortion map between disk and square", Journal of Graphics Tools 2(3), 1997.
#include <cmath>

#include "core/bsdf/angle_basis.h"

namespace lightwalk {

/// A point of the unit square; areas are projected solid angles over π.
struct UnitSquarePoint {
    double x = 0, y = 0;
};

[[nodiscard]] inline UnitSquarePoint disk_to_square(const ProjectedDirection& p) {
    const double radius = std::sqrt(p.x * p.x + p.y * p.y);
    double a = 0, b = 0;
    if (std::abs(p.x) >= std::abs(p.y)) {
        if (p.x != 0) {
            a = std::copysign(radius, p.x);
            b = a * (std::atan(p.y / p.x) * (4 / kPi));
        }
    } else {
        b = std::copysign(radius, p.y);
        a = b * (std::atan(p.x / p.y) * (4 / kPi));
    }
    return {0.5 * (a + 1), 0.5 * (b + 1)};
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
