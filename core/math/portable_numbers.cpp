#include "core/math/portable_numbers.h"

#include <cassert>
#include <cmath>

namespace lightwalk {

void append_integer(std::string& out, std::uint64_t value, int size) {
    for (int k = size - 1; k >= 0; --k) out.push_back(static_cast<char>(value >> (8 * k) & 0xff));
}

void append_real(std::string& out, double value) {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    auto mantissa = static_cast<std::int64_t>(fraction * 0x7fffffff);
    if (exponent > 127) {
        exponent = 127;
        mantissa = value > 0 ? 0x7fffffff : -0x7fffffff;
    } else if (exponent < -128) {
        exponent = 0;
        mantissa = 0;
    }
    append_integer(out, static_cast<std::uint64_t>(mantissa), 4);
    append_integer(out, static_cast<std::uint64_t>(exponent), 1);
}

std::uint64_t take_unsigned_integer(std::string_view& bytes, int size) {
    assert(bytes.size() >= static_cast<std::size_t>(size));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    bytes.remove_prefix(static_cast<std::size_t>(size));
    return value;
}

std::int64_t take_integer(std::string_view& bytes, int size) {
    const std::uint64_t value = take_unsigned_integer(bytes, size);
    const std::uint64_t sign = std::uint64_t{1} << (8 * size - 1);
    return static_cast<std::int64_t>((value ^ sign) - sign);
}

double take_real(std::string_view& bytes) {
    const auto mantissa = static_cast<double>(take_integer(bytes, 4));
    const auto exponent = static_cast<int>(take_integer(bytes, 1));
    if (mantissa == 0) return 0;
    return std::ldexp((mantissa + (mantissa > 0 ? 0.5 : -0.5)) / 2147483647.0, exponent);
}

}  // namespace lightwalk
