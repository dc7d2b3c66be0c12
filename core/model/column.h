#pragma once
// A long array of plain values: grown in memory, or part of a file that is mapped.
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightwalk {

/// Values of a trivially copyable type, side by side. Either owns them, and can grow, or shows
/// those of a mapped file, whose owner keeps it open for as long as the column is used.
template <class T>
class Column {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Column() = default;
    explicit Column(std::vector<T> values) : own_(std::move(values)), values_(own_) {}
    /// Shows values that lie elsewhere; such a column cannot grow.
    [[nodiscard]] static Column mapped(std::span<const T> values) {
        Column column;
        column.values_ = values;
        return column;
    }
    Column(Column&& other) noexcept
        : own_(std::move(other.own_)), values_(std::exchange(other.values_, {})) {
        other.own_.clear();
    }
    Column& operator=(Column&& other) noexcept {
        own_ = std::move(other.own_);
        other.own_.clear();
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
    [[nodiscard]] bool is_mapped() const { return own_.empty() && !values_.empty(); }
    /// In the process's own memory: nothing for mapped values, which processes share.
    [[nodiscard]] std::size_t own_bytes() const { return own_.capacity() * sizeof(T); }

    [[nodiscard]] std::size_t mapped_bytes() const {
        return is_mapped() ? values_.size_bytes() : 0;
    }

    void reserve(std::size_t count) {
        own_.reserve(count);
        values_ = own_;
    }
    void push_back(const T& value) {
        own_.push_back(value);
        values_ = own_;
    }
    void append(std::span<const T> values) {
        own_.insert(own_.end(), values.begin(), values.end());
        values_ = own_;
    }
    /// So many values of its own, new ones zero, to be filled in.
    std::span<T> resize(std::size_t count) {
        own_.resize(count);
        values_ = own_;
        return own_;
    }
    /// Gives back what growing has taken in advance, where that is much.
    void trim() {
        if (own_.capacity() - own_.size() > own_.size() / 8) own_.shrink_to_fit();
        if (!own_.empty()) values_ = own_;
    }

  private:
    std::vector<T> own_;
    std::span<const T> values_;
};

}  // namespace lightwalk
