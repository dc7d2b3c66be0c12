#pragma once
// Values as bytes for other processes, and back. A type lists its fields once, in
//   template <class Wire> void visit_fields(Wire& wire, T& value) { wire(value.a, value.b); }
// beside its declaration; writing, reading and counting follow from it.
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"

namespace lightwalk::wire {

static_assert(std::endian::native == std::endian::little);

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t kCount>
inline constexpr bool is_array<std::array<T, kCount>> = true;
template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_variant = false;
template <class... Kinds>
inline constexpr bool is_variant<std::variant<Kinds...>> = true;

/// Number of an enumeration's values, which are 0, 1, ...: each enumeration on the wire has its
/// own.
template <class Enumeration>
inline constexpr int kEnumerators = 0;

/// Whether values of a type lie in memory as on the wire, numbers one behind the other: lists of
/// them are copied as a whole.
template <class T>
inline constexpr bool kPlain = std::is_arithmetic_v<T>;

[[noreturn]] inline void refuse(const char* problem) {
    throw InputError(std::string("bytes of another rank ") + problem);
}

/// All numbers little-endian as they are in memory, so that a copy is the same value to the bit.
/// bool, enumerations, and whether there is a value take one byte; strings and lists come after
/// their length in 64 bits, alternatives after their index in one byte. Derived takes the numbers:
///   void raw(void* data, std::size_t size);
///   template <class List> void length(List& list);  // reading: resizes the list
///   static constexpr bool kReads;
template <class Derived>
class Wire {
  public:
    template <class... Fields>
    void operator()(Fields&... fields) {
        (one(fields), ...);
    }

  private:
    [[nodiscard]] Derived& self() { return static_cast<Derived&>(*this); }

    template <class T>
    void one(T& value) {
        if constexpr (std::is_same_v<T, bool>) {
            checked(value, 2);
        } else if constexpr (std::is_enum_v<T>) {
            static_assert(kEnumerators<T> > 0);
            checked(value, kEnumerators<T>);
        } else if constexpr (std::is_arithmetic_v<T>) {
            self().raw(&value, sizeof value);
        } else if constexpr (std::is_same_v<T, std::string>) {
            self().length(value);
            self().raw(value.data(), value.size());
        } else if constexpr (is_vector<T>) {
            self().length(value);
            elements(value);
        } else if constexpr (is_array<T>) {
            elements(value);
        } else if constexpr (is_optional<T>) {
            bool there = value.has_value();
            one(there);
            if (Derived::kReads && there) value.emplace();
            if (there) one(*value);
        } else if constexpr (is_variant<T>) {
            alternative(value);
        } else {
            visit_fields(self(), value);
        }
    }

    template <class List>
    void elements(List& list) {
        if constexpr (kPlain<typename List::value_type>)
            self().raw(list.data(), list.size() * sizeof list[0]);
        else
            for (auto& element : list) one(element);
    }

    template <class T>
    void checked(T& value, int count) {
        auto byte = static_cast<std::uint8_t>(value);
        self().raw(&byte, 1);
        if (byte >= count) refuse("hold what cannot be");
        value = static_cast<T>(byte);
    }

    template <class Variant, class Kind>
    [[nodiscard]] static Variant make() {
        return Kind{};
    }
    template <class... Kinds>
    void alternative(std::variant<Kinds...>& value) {
        auto index = static_cast<std::uint8_t>(value.index());
        self().raw(&index, 1);
        if (index >= sizeof...(Kinds)) refuse("are of an unknown kind");
        if constexpr (Derived::kReads) {
            using Make = std::variant<Kinds...> (*)();
            static constexpr Make kMakers[] = {&make<std::variant<Kinds...>, Kinds>...};
            value = kMakers[index]();
        }
        if (!Derived::kOwnSizeOnly) std::visit([&](auto& kind) { one(kind); }, value);
    }
};

class Writer final : public Wire<Writer> {
  public:
    static constexpr bool kReads = false, kOwnSizeOnly = false;
    void raw(const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    }
    template <class List>
    void length(const List& list) {
        const std::uint64_t size = list.size();
        raw(&size, sizeof size);
    }
    std::string bytes;
};

/// Bytes that a value takes, without making them; `kLeast`: of an alternative only its index.
template <bool kLeast>
class Counter final : public Wire<Counter<kLeast>> {
  public:
    static constexpr bool kReads = false, kOwnSizeOnly = kLeast;
    void raw(const void*, std::size_t size) { bytes += size; }
    template <class List>
    void length(const List&) {
        bytes += sizeof(std::uint64_t);
    }
    std::size_t bytes = 0;
};

/// Bytes that any value of a type takes at least.
template <class T>
[[nodiscard]] std::size_t least_size() {
    T value{};
    Counter<true> counter;
    counter(value);
    return counter.bytes;
}

class Reader final : public Wire<Reader> {
  public:
    static constexpr bool kReads = true, kOwnSizeOnly = false;
    explicit Reader(std::string_view bytes) : left_(bytes) {}
    void raw(void* data, std::size_t size) {
        if (size > left_.size()) refuse("are cut short");
        if (size > 0) std::memcpy(data, left_.data(), size);
        left_.remove_prefix(size);
    }
    /// A length that promises more elements than there are bytes for cannot be.
    template <class List>
    void length(List& list) {
        static const std::size_t least = least_size<typename List::value_type>();
        std::uint64_t size = 0;
        raw(&size, sizeof size);
        if (size > left_.size() / least) refuse("promise more than they hold");
        list.resize(size);
    }
    [[nodiscard]] bool at_end() const { return left_.empty(); }

  private:
    std::string_view left_;
};

template <class T>
[[nodiscard]] std::size_t size_of(const T& value) {
    Counter<false> counter;
    counter(const_cast<T&>(value));  // fields are listed for readers as well; this one only looks
    return counter.bytes;
}

template <class T>
[[nodiscard]] std::string encode(const T& value) {
    Writer writer;
    writer.bytes.reserve(size_of(value));
    writer(const_cast<T&>(value));
    return std::move(writer.bytes);
}

/// The inverse. Throws InputError for bytes that encode<T> did not make.
template <class T>
[[nodiscard]] T decode(std::string_view bytes) {
    T value{};
    Reader reader(bytes);
    reader(value);
    if (!reader.at_end()) refuse("are longer than they should be");
    return value;
}

}  // namespace lightwalk::wire
