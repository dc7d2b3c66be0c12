#include "io/language/number_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "core/error.h"

namespace lightwalk {
namespace {

/// Powers of ten that are doubles.
constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int kLargestPower = 22;
constexpr std::uint64_t kLargestMantissa = std::uint64_t{1} << 53;
constexpr std::ptrdiff_t kMostDigits = 19;  ///< any so many digits fit into 64 bits
constexpr std::ptrdiff_t kMostExponentDigits = 3;

/// Append the digits at `at` to `number`, which may overflow; returns where they end.
const char* read_digits(const char* at, const char* end, std::uint64_t& number) {
    for (; at != end; ++at) {
        const auto digit = static_cast<unsigned char>(*at - '0');
        if (digit > 9) break;
        number = number * 10 + digit;
    }
    return at;
}

/// Read what follows an 'e' at `at`. Returns where it ends; null when it is no exponent of few
/// digits.
const char* read_exponent(const char* at, const char* end, int& exponent) {
    ++at;
    const bool negative = at != end && *at == '-';
    if (at != end && (*at == '-' || *at == '+')) ++at;
    std::uint64_t magnitude = 0;
    const char* const stop = read_digits(at, end, magnitude);
    if (stop == at || stop - at > kMostExponentDigits) return nullptr;
    exponent += negative ? -static_cast<int>(magnitude) : static_cast<int>(magnitude);
    return stop;
}

constexpr int kPlainDigits = 12;                ///< what scene text is written with
constexpr std::uint64_t kLeast = 100000000000;  ///< the least whole number with so many digits
/// From here to there %g writes no exponent.
constexpr double kSmallestPlain = 1e-4, kLargestPlain = 1e11;

/// digits / 10^decimals.
struct Decimal {
    std::uint64_t digits = 0;
    int decimals = 0;
};

/// `magnitude`, which is from 1e-4 to below 1e11, rounded to kPlainDigits digits as printf does: to
/// the nearest, seen from its exact value. Nothing for a tie.
std::optional<Decimal> round_plainly(double magnitude) {
    const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(magnitude) >> 52) - 1023;
    // 1233 / 4096 is nearly log10(2): a power that leaves twelve digits before the point, or
    // thirteen.
    for (int power = kPlainDigits - 1 - (binary * 1233 >> 12);; --power) {
        const double scale = kPowersOfTen[static_cast<std::size_t>(power)];
        const double product = magnitude * scale;
        const double error = std::fma(magnitude, scale, -product);  // product + error is exact
        const double whole = std::floor(product);
        const double above_half = (product - whole - 0.5) + error;
        const std::uint64_t digits = static_cast<std::uint64_t>(whole) + (above_half > 0 ? 1 : 0);
        if (digits >= 10 * kLeast) continue;
        if (above_half == 0 || digits < kLeast) return std::nullopt;
        return Decimal{digits, power};
    }
}

void append_decimal(Decimal decimal, std::string& out) {
    for (; decimal.decimals > 0 && decimal.digits % 10 == 0; --decimal.decimals)
        decimal.digits /= 10;
    std::array<char, 20> text{};
    const char* const begin = text.data();
    const char* const end =
        std::to_chars(text.data(), text.data() + text.size(), decimal.digits).ptr;
    const std::ptrdiff_t whole = (end - begin) - decimal.decimals;  // digits before the point
    if (whole > 0) {
        out.append(begin, begin + whole);
    } else {
        out.push_back('0');
    }
    if (decimal.decimals == 0) return;
    out.push_back('.');
    if (whole < 0) out.append(static_cast<std::size_t>(-whole), '0');
    out.append(begin + std::max<std::ptrdiff_t>(whole, 0), end);
}

}  // namespace

std::size_t parse_simple_real(std::string_view text, double& value) {
    const char* const begin = text.data();
    const char* const end = begin + text.size();
    const bool negative = begin != end && *begin == '-';
    const char* const digits = begin + (begin != end && (*begin == '-' || *begin == '+') ? 1 : 0);
    std::uint64_t mantissa = 0;
    const char* at = read_digits(digits, end, mantissa);
    std::ptrdiff_t count = at - digits;
    int exponent = 0;
    if (at != end && *at == '.') {
        const char* const fraction = at + 1;
        at = read_digits(fraction, end, mantissa);
        count += at - fraction;
        exponent = -static_cast<int>(std::min(at - fraction, kMostDigits));
    }
    if (count == 0 || count > kMostDigits || mantissa > kLargestMantissa) return 0;
    if (at != end && (*at == 'e' || *at == 'E')) at = read_exponent(at, end, exponent);
    if (at == nullptr || exponent < -kLargestPower || exponent > kLargestPower) return 0;
    const double scale = kPowersOfTen[static_cast<std::size_t>(std::abs(exponent))];
    const auto whole = static_cast<double>(mantissa);
    const double magnitude = exponent < 0 ? whole / scale : whole * scale;
    value = negative ? -magnitude : magnitude;
    return static_cast<std::size_t>(at - begin);
}

void append_real(double value, int digits, std::string& out) {
    if (!std::isfinite(value)) throw InputError("number out of range");
    const double magnitude = std::abs(value);
    if (magnitude == 0) {
        out += std::signbit(value) ? "-0" : "0";
        return;
    }
    if (digits == kPlainDigits && magnitude >= kSmallestPlain && magnitude < kLargestPlain) {
        if (const std::optional<Decimal> decimal = round_plainly(magnitude)) {
            if (value < 0) out.push_back('-');
            append_decimal(*decimal, out);
            return;
        }
    }
    std::array<char, 40> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value,
                                      std::chars_format::general, digits);
    out.append(text.data(), result.ptr);
}

}  // namespace lightwalk
