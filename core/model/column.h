#pragma once
// A long array of plain values, either grown in memory or part of a mapped file.
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightwalk {

/// A contiguous array of a trivially copyable type. It either owns its values, and can grow, or
/// views values of a mapped file, which must stay mapped while the column is used.
///
/// Unlike std::vector it grows by `realloc`, which remaps the pages of a long array instead of
/// copying them: growing needs no second copy of tens of millions of surfaces.
template <class T>
class Column {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Column() = default;
    explicit Column(const std::vector<T>& values) { append(values); }
    /// A view of values stored elsewhere; it cannot grow.
    [[nodiscard]] static Column mapped(std::span<const T> values) {
        Column column;
        column.values_ = values;
        return column;
    }
    Column(Column&& other) noexcept
        : own_(std::move(other.own_)),
          capacity_(std::exchange(other.capacity_, 0)),
          values_(std::exchange(other.values_, {})) {}
    Column& operator=(Column&& other) noexcept {
        own_ = std::move(other.own_);
        capacity_ = std::exchange(other.capacity_, 0);
        values_ = std::exchange(other.values_, {});
        return *this;
    }
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;
    ~Column() = default;

    [[nodiscard]] std::size_t size() const { return values_.size(); }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    [[nodiscard]] const T* data() const { return values_.data(); }
    [[nodiscard]] const T& operator[](std::size_t i) const { return values_[i]; }
    [[nodiscard]] const T& back() const { return values_.back(); }
    [[nodiscard]] auto begin() const { return values_.begin(); }
    [[nodiscard]] auto end() const { return values_.end(); }
    [[nodiscard]] std::span<const T> values() const { return values_; }
    /// The values for writing; not for a mapped column.
    [[nodiscard]] std::span<T> own_values() { return {own_.get(), own_ ? size() : 0}; }
    [[nodiscard]] bool is_mapped() const { return own_ == nullptr && !values_.empty(); }
    /// Bytes in the process's own memory; 0 for mapped values, which processes share.
    [[nodiscard]] std::size_t own_bytes() const { return capacity_ * sizeof(T); }

    [[nodiscard]] std::size_t mapped_bytes() const {
        return is_mapped() ? values_.size_bytes() : 0;
    }

    void push_back(const T& value) {
        const T kept = value;  // it may be one of these
        if (size() == capacity_) move_to(grown(size() + 1));
        own_.get()[size()] = kept;
        values_ = {own_.get(), size() + 1};
    }
    /// @param values  none of its own
    void append(std::span<const T> values) {
        if (values.empty()) return;
        const std::size_t count = size() + values.size();
        if (count > capacity_) move_to(grown(count));
        std::memcpy(own_.get() + size(), values.data(), values.size_bytes());
        values_ = {own_.get(), count};
    }
    /// Replace the contents by `count` values whose bytes are all zero.
    std::span<T> zeros(std::size_t count) {
        if (count > kMost) throw std::bad_alloc();
        own_.reset(count > 0 ? static_cast<T*>(std::calloc(count, sizeof(T))) : nullptr);
        capacity_ = own_ ? count : 0;
        if (count > 0 && !own_) throw std::bad_alloc();
        values_ = {own_.get(), count};
        return {own_.get(), count};
    }
    /// Reserve address space for `count` values; its pages are not touched before they are used.
    void reserve(std::size_t count) {
        if (count > capacity_) move_to(count);
    }
    /// Release the capacity that is not used.
    void trim() {
        if (own_ == nullptr || size() == capacity_) return;
        if (size() > 0) return move_to(size());
        own_.reset();
        capacity_ = 0;
        values_ = {};
    }

  private:
    static constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(T);

    struct Free {
        void operator()(T* values) const { std::free(values); }  // NOLINT: realloc's partner
    };

    [[nodiscard]] std::size_t grown(std::size_t least) const {
        return std::max({least, 2 * capacity_, std::size_t{16}});
    }
    /// Reallocate to `count` values: positive and at least size().
    void move_to(std::size_t count) {
        if (count > kMost) throw std::bad_alloc();
        void* const moved = std::realloc(own_.get(), count * sizeof(T));  // NOLINT
        if (moved == nullptr) throw std::bad_alloc();
        (void)own_.release();
        own_.reset(static_cast<T*>(moved));
        capacity_ = count;
        values_ = {own_.get(), size()};
    }

    std::unique_ptr<T, Free> own_;
    std::size_t capacity_ = 0;
    std::span<const T> values_;
};

}  // namespace lightwalk
