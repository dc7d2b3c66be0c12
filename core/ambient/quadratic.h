#pragma once
// Roots of a quadratic with the tolerances of the ambient calculation.
#include <cmath>

#include "core/math/vec3.h"

namespace lightwalk {

struct Roots {
    int count = 0;
    double root[2] = {0, 0};
};

/// Real roots of a x² + b x + c. Where |a| <= kEpsilon it is linear; half-discriminants within
/// kEpsilon² of 0 are one root.
[[nodiscard]] inline Roots solve_quadratic(double a, double b, double c) {
    if (std::abs(a) <= kEpsilon) {
        if (std::abs(b) <= kEpsilon) return {};
        return {1, {-c / b, -c / b}};
    }
    const double half = -b / (2 * a), discriminant = half * half - c / a;
    if (discriminant < -kEpsilon * kEpsilon) return {};
    if (std::abs(discriminant) <= kEpsilon * kEpsilon) return {1, {half, half}};
    const double root = std::sqrt(discriminant);
    return {2, {half - root, half + root}};
}

}  // namespace lightwalk
