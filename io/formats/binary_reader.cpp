#include "io/formats/binary_reader.h"

#include <cmath>

namespace lightwalk {

void BinaryReader::fail(const std::string& what) const {
    throw InputError({name_, 0}, what);
}

void BinaryReader::expect(std::uint64_t count, std::size_t size) {
    if (count > remaining() / size) fail("truncated " + kind_);
}

void BinaryReader::skip(std::uint64_t count) {
    expect(count, 1);
    at_ += static_cast<std::size_t>(count);
}

std::uint64_t BinaryReader::unsigned_integer(int size) {
    expect(static_cast<std::uint64_t>(size), 1);
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) {
        value = value << 8 | static_cast<std::uint8_t>(bytes_[at_++]);
    }
    return value;
}

std::int64_t BinaryReader::integer(int size) {
    const std::uint64_t value = unsigned_integer(size);
    const std::uint64_t sign = std::uint64_t{1} << (8 * size - 1);
    return static_cast<std::int64_t>((value ^ sign) - sign);
}

double BinaryReader::real() {
    const auto mantissa = static_cast<double>(integer(4));
    const auto exponent = static_cast<int>(integer(1));
    if (mantissa == 0) return 0;
    return std::ldexp((mantissa + (mantissa > 0 ? 0.5 : -0.5)) / 2147483647.0, exponent);
}

std::string BinaryReader::string() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) fail("truncated " + kind_);
    std::string result(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return result;
}

}  // namespace lightwalk
