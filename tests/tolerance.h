#pragma once
// Tolerances for comparisons in tests, each with its reason, so that no unexplained 0.025 is
// needed.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <type_traits>

namespace lightwalk::test {

/// Relative tolerance of doubles that are computed in two ways: some nine thousand roundings of
/// 2^-53.
inline constexpr double kRounding = 1e-12;
/// Tolerance of doubles near 1 after one or two operations: nine roundings.
inline constexpr double kFewRoundings = 1e-15;
/// Relative tolerance of floats, such as radiances: sixteen roundings of 2^-24.
inline constexpr double kFloatRounding = 0x1p-20;

/// An expected value with its tolerance, for `CHECK(got == rounded(expected))`.
struct Near {
    double value = 0;
    double tolerance = 0;        ///< absolute tolerance for a double
    double float_tolerance = 0;  ///< absolute tolerance for a float

    template <class Real>
    friend bool operator==(const Real& got, const Near& near) {
        const bool is_float = std::is_same_v<Real, float>;
        return std::abs(static_cast<double>(got) - near.value) <=
               (is_float ? near.float_tolerance : near.tolerance);
    }
    friend std::ostream& operator<<(std::ostream& out, const Near& near) {
        const auto digits = out.precision(17);
        out << near.value << " +- " << near.tolerance << " (float: " << near.float_tolerance << ')';
        out.precision(digits);
        return out;
    }
};

/// The size that relative tolerances refer to: that of the value, or 1 for a value of 0.
inline double size_of(double value) {
    return value == 0 ? 1 : std::abs(value);
}

/// Equality up to a share of the value (of 1 for 0); a comment at the call gives the reason for the
/// share.
inline Near within(double share, double value) {
    return {value, share * size_of(value), share * size_of(value)};
}
/// Equality up to rounding, in the precision of the type that is compared.
/// @param size  size of the largest term, where the value is a small difference of larger ones
inline Near rounded(double value, double size = 0) {
    size = std::max(size, size_of(value));
    return {value, kRounding * size, kFloatRounding * size};
}
/// Equality up to rounding in floats, for a double that was computed from floats.
inline Near float_rounded(double value) {
    return within(kFloatRounding, value);
}
/// Equality to a value that was printed with so many significant digits: up to half a unit of the
/// last.
inline Near printed(int digits, double value) {
    const double unit = std::pow(10., std::floor(std::log10(size_of(value))) + 1 - digits);
    return {value, 0.5000001 * unit, 0.5000001 * unit};
}

}  // namespace lightwalk::test
