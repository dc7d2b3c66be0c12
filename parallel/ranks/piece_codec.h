#pragma once
// A finished part of a picture as few bytes, without loss.
#include <string>
#include <string_view>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// Radiance and distance of the pixels of `block`, row by row from its bottom. The bytes of all
/// numbers are sorted by their significance, which puts like beside like, and compressed
/// (Zstandard, RFC 8878).
[[nodiscard]] std::string encode_piece(const PixelRectangle& block,
                                       const std::vector<PixelValue>& values);

/// The inverse. Throws InputError for bytes that hold no such block.
[[nodiscard]] std::vector<PixelValue> decode_piece(const PixelRectangle& block,
                                                   std::string_view bytes);

}  // namespace lightwalk
