#pragma once
// Radiance's portable binary numbers: big-endian integers, 5-byte floats, strings that end in NUL.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace lightwalk {

/// Reads from bytes in memory; every method throws InputError "NAME: truncated KIND" when the bytes
/// end too soon.
class BinaryReader {
  public:
    /// `kind` is the word for the file in messages: "octree", "mesh".
    BinaryReader(std::string_view bytes, std::string name, std::string kind)
        : bytes_(bytes), name_(std::move(name)), kind_(std::move(kind)) {}

    /// A big-endian integer in two's complement; `size` is 1 to 8 [bytes].
    [[nodiscard]] std::int64_t integer(int size);
    [[nodiscard]] std::uint64_t unsigned_integer(int size);
    /// A real of 5 bytes: a signed mantissa m of 4 bytes and an exponent e of 1 byte mean
    /// (m ± 0.5) / 2147483647 · 2^e, and 0 for m = 0.
    [[nodiscard]] double real();
    [[nodiscard]] std::string string() { return std::string(text()); }
    /// A string as a view of the bytes; a zero byte follows it there.
    [[nodiscard]] std::string_view text();
    void skip(std::uint64_t count);

    /// Throws unless `count` values of at least `size` bytes each can still follow, so that a
    /// damaged count cannot cause a large allocation.
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
