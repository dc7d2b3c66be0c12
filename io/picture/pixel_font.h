#pragma once
// Letters of 5 x 7 pixels, for numbers in pictures.
#include <string_view>

#include "io/picture/picture.h"

namespace lightwalk {

inline constexpr int kLetterWidth = 6;   ///< of a letter and the gap behind it [pixels]
inline constexpr int kLetterHeight = 8;  ///< likewise, with the gap below

/// Draws a line of text; what is beside the picture is left out.
/// @param x, y  the upper left corner, from that of the picture [pixels]
/// @param text  in ASCII; other bytes leave a gap
/// @param size  pixels a dot of a letter is wide and high
void draw_text(Picture& picture, int x, int y, std::string_view text, const Rgb& colour, int size);

}  // namespace lightwalk
