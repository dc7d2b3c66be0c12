#pragma once
// Published closed forms of illuminating engineering, to compare the renderer with, and Gauss's
// quadrature for those that are integrals. Lengths in metres, angles in radians.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk::test {

/// What the analytic cases are allowed to differ by, as those of CIE 171:2006 are judged.
inline constexpr double kCase = 0.01;

/// Configuration factor from a surface element to a polygon: the share of light from the element
/// that goes there; times π L, the irradiance [W/m²] from a polygon of radiance L. What lies below
/// the element's horizon is cut off.
/// Source: Lambert, "Photometria" (1760); in this form: Baum, Rushmeier & Winget, "Improving
/// radiosity solutions through the use of analytically determined form-factors", SIGGRAPH 1989.
/// @param corners  flat, in either order
inline double lambert_factor(const Vec3& point, const Vec3& normal,
                             const std::vector<Vec3>& corners) {
    std::vector<Vec3> seen;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
        const double height_a = dot(a, normal), height_b = dot(b, normal);
        if (height_a >= 0) seen.push_back(a);
        if ((height_a >= 0) != (height_b >= 0))
            seen.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    double sum = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Vec3 a = seen[i], b = seen[(i + 1) % seen.size()], across = cross(a, b);
        const double sine = length(across);
        if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(normal, across) / sine;
    }
    return std::abs(sum) / (2 * kPi);
}

/// A rectangle from a corner and two sides.
inline std::vector<Vec3> rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}

/// The same polygon with its front, from where its corners run counterclockwise, to the point.
inline std::vector<Vec3> facing(std::vector<Vec3> corners, const Vec3& point) {
    const Vec3 front = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (dot(front, point - corners[0]) < 0) std::reverse(corners.begin(), corners.end());
    return corners;
}

/// Element to a parallel rectangle a x b at distance c, above one of whose corners it lies. Source:
/// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3.
inline double factor_to_parallel(double a, double b, double c) {
    const double x = a / c, y = b / c, wide = std::sqrt(1 + x * x), deep = std::sqrt(1 + y * y);
    return (x / wide * std::atan(y / wide) + y / deep * std::atan(x / deep)) / (2 * kPi);
}

/// Element to a rectangle that is perpendicular to its plane: as wide as `b`, as high as `a`, at
/// distance c; a lower corner is at the foot of the element's perpendicular. Source: Howell, B-4.
inline double factor_to_upright(double a, double b, double c) {
    const double x = a / b, y = c / b, root = std::sqrt(x * x + y * y);
    return (std::atan(1 / y) - y / root * std::atan(1 / root)) / (2 * kPi);
}

/// Between equal parallel rectangles a x b at distance c, opposite each other. Source: Howell,
/// C-11.
inline double factor_between_parallel(double a, double b, double c) {
    const double x = a / c, y = b / c, x1 = std::sqrt(1 + x * x), y1 = std::sqrt(1 + y * y);
    return 2 / (kPi * x * y) *
           (std::log(x1 * y1 / std::sqrt(1 + x * x + y * y)) + x * y1 * std::atan(x / y1) +
            y * x1 * std::atan(y / x1) - x * std::atan(x) - y * std::atan(y));
}

/// From a rectangle l x w to one of h x l that is perpendicular to it and shares the side l.
/// Source: Howell, C-14.
inline double factor_between_upright(double l, double w, double h) {
    const double W = w / l, H = h / l, w2 = W * W, h2 = H * H, both = h2 + w2;
    const double logs = std::log((1 + w2) * (1 + h2) / (1 + both)) +
                        w2 * std::log(w2 * (1 + both) / ((1 + w2) * both)) +
                        h2 * std::log(h2 * (1 + both) / ((1 + h2) * both));
    return (W * std::atan(1 / W) + H * std::atan(1 / H) -
            std::sqrt(both) * std::atan(1 / std::sqrt(both)) + 0.25 * logs) /
           (kPi * W);
}

/// Between coaxial parallel disks of radii r1 and r2 at distance a, from the first to the second.
/// Source: Howell, C-41.
inline double factor_between_disks(double r1, double r2, double a) {
    const double x1 = r1 / a, x2 = r2 / a, x = 1 + (1 + x2 * x2) / (x1 * x1);
    return 0.5 * (x - std::sqrt(x * x - 4 * (x2 / x1) * (x2 / x1)));
}

/// Nodes in 0 ... 1 and weights, of sum 1, of Gauss's quadrature with n points. Source: Newton's
/// iteration for the zeros of Legendre's polynomial; Abramowitz & Stegun, 25.4.29.
struct GaussRule {
    std::vector<double> at, weight;
    explicit GaussRule(int n) {
        for (int i = 0; i < n; ++i) {
            double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
            for (int step = 0; step < 50; ++step) {
                double p = 1, before = 0;
                for (int k = 0; k < n; ++k) {
                    const double older = before;
                    before = p;
                    p = ((2 * k + 1) * x * before - k * older) / (k + 1);
                }
                slope = n * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            at.push_back(0.5 * (1 - x));
            weight.push_back(1 / ((1 - x * x) * slope * slope));
        }
    }
};

/// Irradiance of an element by light that comes through an opening, whose radiance is given by
/// direction: the integral of L cosθ cosθ' / r² over the opening's area.
/// @param radiance  of the unit direction from the element
inline double irradiance_through(const Vec3& point, const Vec3& normal, const Vec3& corner,
                                 const Vec3& u, const Vec3& v,
                                 const std::function<double(const Vec3&)>& radiance) {
    static const GaussRule kRule(16);
    const Vec3 area = cross(u, v);
    double sum = 0;
    for (std::size_t i = 0; i < kRule.at.size(); ++i)
        for (std::size_t k = 0; k < kRule.at.size(); ++k) {
            const Vec3 way = corner + u * kRule.at[i] + v * kRule.at[k] - point;
            const double squared = length_squared(way), cosine = dot(normal, way);
            if (cosine > 0)
                sum += kRule.weight[i] * kRule.weight[k] * radiance(normalize(way)) * cosine *
                       std::abs(dot(area, way)) / (squared * squared);
        }
    return sum;
}

/// Transmittance of a clear pane for unpolarised light, with all reflections between its faces.
/// Sources: Fresnel's equations and Stokes's series, as in Born & Wolf, "Principles of Optics",
/// 1.5 and 7.6 without interference.
/// @param internal  what a crossing at normal incidence leaves of the light
inline double pane_transmittance_of(double cosine, double index, double internal) {
    const double sine = std::sqrt(1 - cosine * cosine) / index;
    const double inside = std::sqrt(1 - sine * sine);
    const double tau = std::pow(internal, 1 / inside);
    const double s = std::pow((cosine - index * inside) / (cosine + index * inside), 2);
    const double p = std::pow((inside - index * cosine) / (inside + index * cosine), 2);
    const auto through = [&](double r) {
        return (1 - r) * (1 - r) * tau / (1 - r * r * tau * tau);
    };
    return 0.5 * (through(s) + through(p));
}

}  // namespace lightwalk::test
