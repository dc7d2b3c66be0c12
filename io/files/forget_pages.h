#pragma once
// Gives the memory of a long text back to the operating system while the text is being read.
#include <cstddef>
#include <span>
#include <string>

namespace lightwalk {

/// Give the pages that lie wholly within `bytes` back to the system. Their contents are undefined
/// from then on, but the memory may be written and freed as before. Without support of the system
/// nothing happens.
void forget_pages(std::span<char> bytes) noexcept;

/// A text that is read once, from front to back, and whose memory is given back meanwhile.
class FadingText {
  public:
    explicit FadingText(std::string& text) : text_(text) {}

    /// Promise that the first `offset` characters will not be read again. `offset` must not
    /// decrease. Memory is given back in stretches of eight megabytes; other calls cost next to
    /// nothing.
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
