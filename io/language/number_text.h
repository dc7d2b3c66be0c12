#pragma once
// Conversion between numbers and text, with a fast path for plain decimals, as nearly all numbers
// of scene files are.
#include <cstddef>
#include <string>
#include <string_view>

namespace lightwalk {

/// Read a plain decimal at the beginning of `text`: [+-]digits[.digits], then perhaps an exponent.
/// Plain means: the digits are an integer below 2^53, times 10^k with k from -22 to 22. Both
/// factors are doubles without rounding, so one product or quotient of them is the nearest double,
/// equal to the result of std::from_chars. Source: Clinger, "How to read floating point numbers
/// accurately", PLDI (1990).
/// @return  the number of characters read; 0, with `value` unchanged, when the number is not plain
[[nodiscard]] std::size_t parse_simple_real(std::string_view text, double& value);

/// Append `value` as printf's %.Ng in the C locale, with N = `digits`. Throws InputError for a
/// number that is not finite.
void append_real(double value, int digits, std::string& out);

}  // namespace lightwalk
