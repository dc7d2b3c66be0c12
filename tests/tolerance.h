#pragma once
// What two figures may differ by in a test, each with its reason, so that no bare 0.025 is needed.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <type_traits>

namespace lightwalk::test {

/// Of doubles that are computed in two ways: some nine thousand roundings, of 2^-53 each. A share.
inline constexpr double kRounding = 1e-12;
/// Of doubles near 1 after a step or two: nine roundings.
inline constexpr double kFewRoundings = 1e-15;
/// Of floats, as radiances are: sixteen roundings, of 2^-24 each. A share.
inline constexpr double kFloatRounding = 0x1p-20;

/// A figure and how far off another one may be, for `CHECK(got == rounded(expected))`.
struct Near {
    double value = 0;
    double tolerance = 0;        ///< absolute
    double float_tolerance = 0;  ///< the same, where what is compared is a float

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

/// What shares are of: the value's own size, or 1 for a value of 0.
inline double size_of(double value) {
    return value == 0 ? 1 : std::abs(value);
}

/// Within a share of the value (of 1 for 0): a comment beside it says where the share comes from.
inline Near within(double share, double value) {
    return {value, share * size_of(value), share * size_of(value)};
}
/// The same but for rounding, in the precision of what is compared with it.
/// @param size  of the largest term, where the value is a small difference of larger ones
inline Near rounded(double value, double size = 0) {
    size = std::max(size, size_of(value));
    return {value, kRounding * size, kFloatRounding * size};
}
/// The same but for rounding in floats, for a double that floats were made into.
inline Near float_rounded(double value) {
    return within(kFloatRounding, value);
}
/// A figure that was printed with so many significant digits: half a unit of the last one.
inline Near printed(int digits, double value) {
    const double unit = std::pow(10., std::floor(std::log10(size_of(value))) + 1 - digits);
    return {value, 0.5000001 * unit, 0.5000001 * unit};
}

}  // namespace lightwalk::test
