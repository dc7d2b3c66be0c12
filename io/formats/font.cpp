#include <algorithm>

#include "core/model/transform_args.h"
#include "io/formats/decode.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr long kMaxVertices = 32000;
constexpr long kGrid = 255;

/// An integer in [lowest, highest]; `what` names it in messages.
long integer(WordReader& words, std::string_view word, const std::string& what, long lowest,
             long highest) {
    long value = 0;
    if (!parse_integer(word, value) || value < lowest || value > highest) {
        throw words.error("font load error: " + what + " \"" + std::string(word) +
                          "\", expected an integer from " + std::to_string(lowest) + " to " +
                          std::to_string(highest));
    }
    return value;
}

long next_integer(WordReader& words, const std::string& what, long lowest, long highest) {
    const std::optional<std::string_view> word = words.next();
    if (!word) throw words.error("font load error: the file ends before " + what);
    return integer(words, *word, what, lowest, highest);
}

/// Extents grow from the middle of the cell, as Radiance has them.
void extend(std::int16_t& low, std::int16_t& high, std::uint8_t to) {
    if (to < low)
        low = to;
    else if (to > high)
        high = to;
}

Font::Glyph read_glyph(WordReader& words) {
    Font::Glyph glyph;
    glyph.defined = true;
    const auto count =
        static_cast<std::size_t>(next_integer(words, "a vertex count", 0, kMaxVertices));
    if (2 * count > words.most_left())
        throw words.error("font load error: the file ends before a vertex");
    glyph.vertices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto x =
            static_cast<std::uint8_t>(next_integer(words, "a vertex coordinate", 0, kGrid));
        const auto y =
            static_cast<std::uint8_t>(next_integer(words, "a vertex coordinate", 0, kGrid));
        extend(glyph.left, glyph.right, x);
        extend(glyph.bottom, glyph.top, y);
        glyph.vertices.push_back({x, y});
    }
    return glyph;
}

int mean_width(const Font& font) {
    int sum = 0, count = 0;
    for (const Font::Glyph& glyph : font.glyphs) {
        if (glyph.right == glyph.left || glyph.top == glyph.bottom) continue;
        sum += glyph.right - glyph.left;
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

}  // namespace

Font decode_font(std::string_view text, const std::string& name) {
    Font font;
    WordReader words(text, name);
    while (const std::optional<std::string_view> word = words.next()) {
        const long code = integer(words, *word, "glyph number", 1, 255);
        Font::Glyph& glyph = font.glyphs[static_cast<std::size_t>(code)];
        if (glyph.defined)
            throw words.error("font load error: duplicate glyph " + std::to_string(code));
        glyph = read_glyph(words);
    }
    font.mean_width = mean_width(font);
    return font;
}

}  // namespace lightwalk
