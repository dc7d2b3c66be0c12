#pragma once
// Large memory pages for long texts.
#include <cstddef>
#include <string>

namespace lightwalk {

/// The least size of texts for which pages of two megabytes are worth asking for [bytes].
inline constexpr std::size_t kWorthLargePages = std::size_t{4} << 20;

/// Asks the system for large pages for the room of a text that is worth it and should not have been
/// touched yet. The first touch of each page of 4 kB takes a good part of the time in which a long
/// text is read, above all on virtual machines. This is a hint: the text stays, and a
/// system without large pages ignores it.
void prefer_large_pages(std::string& text) noexcept;

}  // namespace lightwalk
