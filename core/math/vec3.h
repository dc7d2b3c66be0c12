#pragma once
// Vectors and points in double precision. Points are row vectors: p' = p M.
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lightwalk {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kEpsilon = 1e-6;  ///< Radiance's universal small number [m] or [1]
inline constexpr double kHuge = 1e10;     ///< the distance that means "nothing was hit" [m]

struct Vec3 {
    double x = 0, y = 0, z = 0;

    constexpr double& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr double operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
    constexpr Vec3& operator-=(const Vec3& b) { return *this = {x - b.x, y - b.y, z - b.z}; }
    constexpr Vec3& operator*=(double s) { return *this = {x * s, y * s, z * s}; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, const Vec3& b) {
    return a += b;
}
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, const Vec3& b) {
    return a -= b;
}
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a) {
    return {-a.x, -a.y, -a.z};
}
[[nodiscard]] constexpr Vec3 operator*(Vec3 a, double s) {
    return a *= s;
}
[[nodiscard]] constexpr Vec3 operator*(double s, Vec3 a) {
    return a *= s;
}
[[nodiscard]] constexpr Vec3 operator/(Vec3 a, double s) {
    return a *= 1 / s;
}
[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] constexpr double length_squared(const Vec3& a) {
    return dot(a, a);
}
[[nodiscard]] inline double length(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
/// The dot product with fused multiply-adds, in the order in which compilers contract a.x b.x + a.y
/// b.y + a.z b.z.
[[nodiscard]] inline double fused_dot(const Vec3& a, const Vec3& b) {
    return std::fma(a.z, b.z, std::fma(a.x, b.x, a.y * b.y));
}
/// The unit vector along `a`; the zero vector stays zero. Vectors of nearly unit length (from a
/// text file, say) are corrected to first order, as Radiance does: within 4e-13.
[[nodiscard]] inline Vec3 normalize(const Vec3& a) {
    const double n = fused_dot(a, a);
    if (std::abs(n - 1) <= kEpsilon) return a * (2 - (0.5 + 0.5 * n));
    return n > 0 ? a / std::sqrt(n) : Vec3{};
}
/// origin + direction t, fused: the point lies beside its surface by the rounding of t instead of
/// snapping to round coordinates. Patterns that jump on a lattice plane, where walls like to stand,
/// then see both sides of it, as they do in Radiance, whose released programs are built with fused
/// multiply-adds.
[[nodiscard]] inline Vec3 fused_advance(const Vec3& origin, const Vec3& direction, double t) {
    return {std::fma(direction.x, t, origin.x), std::fma(direction.y, t, origin.y),
            std::fma(direction.z, t, origin.z)};
}

/// A unit vector perpendicular to the unit vector `n`: e x n for the last axis e (z, then y, then
/// x) whose component of n lies strictly between -0.6 and 0.6. Fixed, so that light source sampling
/// is repeatable.
[[nodiscard]] inline Vec3 perpendicular(const Vec3& n) {
    Vec3 e;
    if (n.z > -0.6 && n.z < 0.6)
        e.z = 1;
    else if (n.y > -0.6 && n.y < 0.6)
        e.y = 1;
    else
        e.x = 1;
    return normalize(cross(e, n));
}

}  // namespace lightwalk
