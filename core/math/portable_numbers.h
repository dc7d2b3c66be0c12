#pragma once
// Numbers as Radiance's portable binary files hold them: big-endian integers, and reals of a
// four-byte mantissa with a one-byte exponent of two.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lightwalk {

inline constexpr std::size_t kPortableRealSize = 5;  ///< bytes

/// Append the lowest `size` (1 to 8) bytes of `value`, most significant byte first.
void append_integer(std::string& out, std::uint64_t value, int size);
/// Append a real of 5 bytes; its mantissa is truncated to 31 bits. Values beyond 2^127 become the
/// largest real, values below 2^-128 zero.
void append_real(std::string& out, double value);
inline void append_real(std::string& out, float value) {
    append_real(out, static_cast<double>(value));
}

/// Read an integer from the first `size` bytes and remove them from `bytes`, which must hold as
/// many.
[[nodiscard]] std::uint64_t take_unsigned_integer(std::string_view& bytes, int size);
[[nodiscard]] std::int64_t take_integer(std::string_view& bytes, int size);
/// Read a real from the first 5 bytes and remove them: (m ± 0.5) / 2147483647 · 2^e, and 0 for m =
/// 0.
[[nodiscard]] double take_real(std::string_view& bytes);

}  // namespace lightwalk
