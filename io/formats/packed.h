#pragma once
// Serialisation of numbers, texts and lists in native byte order, for files that are read on the
// same kind of machine as they were written.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightwalk {

/// Types that may be copied byte by byte. bool is not among them, as not every byte is a valid one.
template <class T>
concept Packable = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                   !std::is_same_v<T, bool> && !std::is_same_v<T, std::string_view>;

/// Appends values: numbers as they are in memory, texts and lists after their length in 64 bits, a
/// bool as one byte.
class PackedWriter {
  public:
    template <Packable T>
    void number(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void boolean(bool value) { number(static_cast<std::uint8_t>(value ? 1 : 0)); }
    void count(std::size_t value) { number(static_cast<std::uint64_t>(value)); }
    void text(std::string_view text);
    template <Packable T>
    void list(std::span<const T> values) {
        count(values.size());
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    }
    template <Packable T>
    void list(const std::vector<T>& values) {
        list(std::span<const T>(values));
    }
    void texts(std::span<const std::string> texts);
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Reads what PackedWriter wrote. Every method throws InputError "NAME: damaged: WHAT" when the
/// bytes end too soon, before anything is allocated for them.
class PackedReader {
  public:
    /// @param name  the name of the file, for messages
    /// @param what  what the bytes hold, for messages: "the list of files"
    PackedReader(std::span<const std::byte> bytes, std::string name, std::string what);

    template <Packable T>
    [[nodiscard]] T number() {
        T value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    [[nodiscard]] bool boolean();  ///< throws for a byte that is neither 0 nor 1
    /// The number of items that follow, of at least `least` bytes each; throws for a number that
    /// the remaining bytes cannot hold.
    [[nodiscard]] std::size_t count(std::size_t least);
    [[nodiscard]] std::string text();
    template <Packable T>
    [[nodiscard]] std::vector<T> list() {
        std::vector<T> values(count(sizeof(T)));
        if (!values.empty())
            std::memcpy(values.data(), take(values.size() * sizeof(T)), values.size() * sizeof(T));
        return values;
    }
    [[nodiscard]] std::vector<std::string> texts();
    /// Throws unless all bytes have been read.
    void end() const;
    /// Throws InputError.
    [[noreturn]] void fail() const;

  private:
    [[nodiscard]] const std::byte* take(std::size_t size);

    std::span<const std::byte> bytes_;
    std::string name_, what_;
};

}  // namespace lightwalk
