#pragma once
// Gives the memory of long texts back to the system while they are read.
#include <cstddef>
#include <span>
#include <string>

namespace lightwalk {

/// Give back the pages that lie wholly within `bytes`, which are undefined from then on, though
/// they may be written and freed as before. Where the system does not take them they stay as they
/// are.
void forget_pages(std::span<char> bytes) noexcept;

/// A text that is read once, from front to back: its memory goes while it is read.
class FadingText {
  public:
    explicit FadingText(std::string& text) : text_(text) {}

    /// The first `offset` characters will not be looked at again; never less than before. Costs
    /// nothing until another few megabytes are read.
    void read_to(std::size_t offset) {
        if (offset >= forgotten_ + kStretch) forget_to(offset);
    }

  private:
    static constexpr std::size_t kStretch = std::size_t{8} << 20;
    void forget_to(std::size_t offset);

    std::string& text_;
    std::size_t forgotten_ = 0;
};

}  // namespace lightwalk
