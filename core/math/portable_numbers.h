#pragma once
// Numbers as Radiance's portable binary files hold them: big-endian integers, and reals of a
// four-byte mantissa with a one-byte exponent of two.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lightwalk {

inline constexpr std::size_t kPortableRealSize = 5;  ///< bytes

/// Append the lowest `size` bytes, 1 to 8, the most significant first.
void append_integer(std::string& out, std::uint64_t value, int size);
/// Append 5 bytes; the mantissa is cut off at 31 bits. Beyond 2^127 the largest real, below 2^-128
/// zero.
void append_real(std::string& out, float value);

/// The number in the first bytes, which are taken off the front. `bytes` must hold so many.
[[nodiscard]] std::uint64_t take_unsigned_integer(std::string_view& bytes, int size);
[[nodiscard]] std::int64_t take_integer(std::string_view& bytes, int size);
/// (m ± 0.5) / 2147483647 · 2^e; 0 for m = 0.
[[nodiscard]] double take_real(std::string_view& bytes);

}  // namespace lightwalk
