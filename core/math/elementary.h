#pragma once
// Elementary functions made of basic IEEE 754 operations only, so that every processor computes the
// same bits. They have no branches and can be vectorised (SIMD).
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lightwalk {
namespace elementary {

inline constexpr double kHalfPi = 0x1.921fb54442d18p+0;
inline constexpr double kHalfPiRest =
    0x1.1a62633145c07p-54;  ///< π/2 - kHalfPi, the low-order part of π/2
/// 1.5 * 2^52. Adding it to a number below 2^51 rounds that to an integer, which is then found in
/// the lowest bits of the sum.
inline constexpr double kWhole = 0x1.8p+52;

/// c[0] + c[1] x + ...
template <std::size_t n>
[[gnu::always_inline]] constexpr double polynomial(const std::array<double, n>& c, double x) {
    double sum = c[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) sum = sum * x + c[i];
    return sum;
}

/// 2^n for an integer n from -1022 to 1023.
[[gnu::always_inline]] inline double power_of_two(double n) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(n + 1023 + kWhole) << 52);
}

/// Taylor coefficients of (e^x - 1 - x) / x²; later terms are below double precision for |x| <
/// log(2) / 2.
inline constexpr std::array<double, 12> kExpSeries{
    1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,      1.0 / 720,       1.0 / 5040,
    1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0};

/// Polynomial in s² for (asin(s) / s - 1) / s², s² from 0 to 1/4, interpolated at Chebyshev nodes;
/// its error is at most 5e-18 s².
inline constexpr std::array<double, 13> kAsin{
    0x1.5555555555556p-3, 0x1.3333333332ecap-4, 0x1.6db6db6e31f13p-5, 0x1.f1c71c1db0623p-6,
    0x1.6e8bb1c8209a2p-6, 0x1.1c4d35cf95421p-6, 0x1.c9cf07674736ap-7, 0x1.782651caa6547p-7,
    0x1.52420b04b37bep-7, 0x1.65a9c4dfcf8b2p-8, 0x1.1d189408314eep-6, -0x1.e6aaa8a0a04ccp-7,
    0x1.d72b2bc8155f8p-6};

/// e^x with an error below one unit in the last place; infinity on overflow, 0 on underflow.
[[gnu::always_inline]] inline double exp(double x) {
    constexpr double kLog2 = 0x1.62e42feep-1, kLog2Rest = 0x1.a39ef35793c76p-33;
    const double below = x > 710 ? 710 : x;
    const double bounded = below < -746 ? -746 : below;
    const double n = (bounded * 0x1.71547652b82fep+0 + kWhole) - kWhole;
    const double r = (bounded - n * kLog2) - n * kLog2Rest;
    const double e = 1 + (r + r * r * polynomial(kExpSeries, r));
    const double half = (n * 0.5 + kWhole) - kWhole;  // beyond the range of one factor
    return e * power_of_two(half) * power_of_two(n - half);
}

/// Arc cosine, 0 to π, with an error below two units in the last place; NaN for |x| > 1.
[[gnu::always_inline]] inline double acos(double x) {
    const double size = std::fabs(x);
    const bool steep = size > 0.5;  // there by half the angle: acos(x) = 2 asin(√((1 - x) / 2))
    const double square = steep ? 0.5 * (1 - size) : x * x;
    const double root = std::sqrt(square);
    const double sine = steep ? root : size;
    const double angle = sine + sine * (square * polynomial(kAsin, square));
    const double toward = x < 0 ? -angle : angle;
    const double flat = kHalfPi - (toward - kHalfPiRest);
    const double back = 2 * (kHalfPi - (angle - kHalfPiRest));
    const double ends = x < 0 ? back : 2 * angle;
    return steep ? ends : flat;
}

}  // namespace elementary
}  // namespace lightwalk
