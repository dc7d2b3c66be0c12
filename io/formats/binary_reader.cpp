#include "io/formats/binary_reader.h"

#include "core/math/portable_numbers.h"

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

std::string_view BinaryReader::next(int size) {
    const auto count = static_cast<std::size_t>(size);
    expect(count, 1);
    at_ += count;
    return bytes_.substr(at_ - count, count);
}

std::uint64_t BinaryReader::unsigned_integer(int size) {
    std::string_view bytes = next(size);
    return take_unsigned_integer(bytes, size);
}

std::int64_t BinaryReader::integer(int size) {
    std::string_view bytes = next(size);
    return take_integer(bytes, size);
}

double BinaryReader::real() {
    std::string_view bytes = next(kPortableRealSize);
    return take_real(bytes);
}

std::string_view BinaryReader::text() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) fail("truncated " + kind_);
    const std::string_view result = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return result;
}

}  // namespace lightwalk
