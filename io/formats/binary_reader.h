#pragma once
// Radiance's portable binary numbers: big-endian integers, 5-byte floats, strings that end in NUL.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace lightwalk {

/// Reads from bytes in memory; every method throws InputError "NAME: truncated KIND" at their end.
class BinaryReader {
  public:
    /// `kind` is what messages call the file: "octree", "mesh".
    BinaryReader(std::string_view bytes, std::string name, std::string kind)
        : bytes_(bytes), name_(std::move(name)), kind_(std::move(kind)) {}

    /// Most significant byte first, two's complement; `size` is 1 to 8 bytes.
    [[nodiscard]] std::int64_t integer(int size);
    [[nodiscard]] std::uint64_t unsigned_integer(int size);
    /// (m ± 0.5) / 2147483647 · 2^e, from a 4-byte mantissa m with a sign and a 1-byte exponent e;
    /// 0 for m = 0.
    [[nodiscard]] double real();
    [[nodiscard]] std::string string() { return std::string(text()); }
    /// The same where it stands in the bytes: a zero byte follows.
    [[nodiscard]] std::string_view text();
    void skip(std::uint64_t count);

    /// Throws unless `count` more values of at least `size` bytes each can follow: a bound for what
    /// is allocated.
    void expect(std::uint64_t count, std::size_t size);
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }
    [[noreturn]] void fail(const std::string& what) const;
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    [[nodiscard]] std::string_view next(int size);

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::string name_, kind_;
};

}  // namespace lightwalk
