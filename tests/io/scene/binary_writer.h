#pragma once
// Octree and mesh files for tests, byte by byte.
#include <cmath>
#include <cstdint>
#include <string>

namespace lightwalk::test {

class BinaryWriter {
  public:
    BinaryWriter& integer(std::int64_t value, int size) {
        for (int i = size - 1; i >= 0; --i) {
            bytes_.push_back(
                static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
        }
        return *this;
    }
    BinaryWriter& text(const std::string& string) {
        bytes_ += string;
        bytes_.push_back('\0');
        return *this;
    }
    BinaryWriter& raw(const std::string& bytes) {
        bytes_ += bytes;
        return *this;
    }
    /// The 5-byte float as Radiance writes it: mantissa truncated to 31 bits.
    BinaryWriter& real(double value) {
        int exponent = 0;
        const double fraction = std::frexp(value, &exponent);
        integer(static_cast<std::int64_t>(fraction * 2147483647.0), 4);
        return integer(value == 0 ? 0 : exponent, 1);
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Header, magic, cube.
inline BinaryWriter begin_file(const std::string& format, int magic,
                               const std::string& edge = "4.5") {
    BinaryWriter file;
    file.raw("#?RADIANCE\noconv -f x.rad\nFORMAT=" + format + "\n\n").integer(magic, 2);
    file.text("-1").text("-2").text("-3").text(edge);
    return file;
}

}  // namespace lightwalk::test
