#pragma once
// Numbers of the scene language as text: the plain ones, which nearly all are, without the detours
// of the others.
#include <cstddef>
#include <string>
#include <string_view>

namespace lightwalk {

/// Read a plain decimal at the beginning of `text`: [+-]digits[.digits], then perhaps an exponent.
/// It is taken when its digits are a whole number below 2^53 times a power of ten from -22 to 22:
/// both are doubles, and so the one product or quotient is the nearest double, as std::from_chars
/// finds it. Source: Clinger, "How to read floating point numbers accurately", PLDI (1990).
/// @return  how many characters the number has; 0 when it is not so plain, and `value` is as it was
[[nodiscard]] std::size_t parse_simple_real(std::string_view text, double& value);

/// Append `value` as printf's %.Ng in the C locale, N being `digits`. Throws InputError for a
/// number that is not finite.
void append_real(double value, int digits, std::string& out);

}  // namespace lightwalk
