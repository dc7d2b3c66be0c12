#include "core/texture/text_layout.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr int kCell = 255;  // grid units a character cell
using Spacings = std::vector<std::int64_t>;

const Font::Glyph& glyph_of(const Font& font, char c) {
    return font.glyphs[static_cast<unsigned char>(c)];
}
bool is_blank(const Font& font, char c) {
    return glyph_of(font, c).defined && glyph_of(font, c).vertices.empty();
}

/// n + 1 spacings of a line of n characters: before the first one and after each.
Spacings uniform_spacings(const Font& font, const std::string& text) {
    Spacings spacings{0};
    for (const char c : text) spacings.push_back(glyph_of(font, c).defined ? kCell : 0);
    return spacings;
}

/// Outlines `gap` grid units apart, half of it at either end of the line.
Spacings squeezed_spacings(const Font& font, const std::string& text, std::int64_t gap) {
    Spacings spacings;
    const std::int64_t half = gap / 2;
    std::int64_t pending = half;
    bool leading = true;
    for (const char c : text) {
        const Font::Glyph& glyph = glyph_of(font, c);
        leading = leading && !glyph.defined;
        if (leading) {
            spacings.push_back(0);
        } else if (!glyph.defined) {
            spacings.push_back(pending);
            pending = 0;
        } else if (glyph.vertices.empty()) {
            spacings.push_back(pending);
            pending = font.mean_width;
        } else {
            spacings.push_back(pending + half - glyph.left);
            pending = glyph.right + half;
        }
    }
    spacings.push_back(pending + half);
    return spacings;
}

/// A stretch of a line that keeps the width its characters have in a font of equal widths: up to a
/// character that three or more blanks follow.
struct Group {
    std::size_t end = 0;     ///< first character after the group
    std::int64_t cells = 0;  ///< known characters
};

Group group_at(const Font& font, const std::string& text, std::size_t begin) {
    Group group;
    for (std::size_t at = begin; at < text.size(); at = group.end) {
        group.end = at + 1;
        if (!glyph_of(font, text[at]).defined) continue;
        while (group.end < text.size() && is_blank(font, text[group.end])) ++group.end;
        group.cells += static_cast<std::int64_t>(group.end - at);
        if (group.end - at > 3) break;
    }
    return group;
}

/// Squeezed, then every group stretched to as many mean cells as it has characters.
Spacings proportional_spacings(const Font& font, const std::string& text, std::int64_t gap) {
    Spacings spacings = squeezed_spacings(font, text, gap);
    for (std::size_t begin = 0; begin < text.size();) {
        const Group group = group_at(font, text, begin);
        std::int64_t excess = group.cells * (font.mean_width + gap);
        for (std::size_t i = begin; i < group.end; ++i) excess -= spacings[i + 1];
        for (std::size_t i = begin; i < group.end; ++i) {
            const std::int64_t share = excess / static_cast<std::int64_t>(group.end - i);
            spacings[i + 1] += share;
            excess -= share;
        }
        begin = group.end;
    }
    return spacings;
}

/// Whether the closed polygon of a glyph holds (x, y), by crossings of the ray along +x. Vertices
/// are compared with the middle of the grid unit that holds the point, so that none lies on the
/// ray.
bool glyph_holds(const Font::Glyph& glyph, double x, double y) {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    if (column < glyph.left || column >= glyph.right || row < glyph.bottom || row >= glyph.top)
        return false;
    bool inside = false;
    std::array<std::uint8_t, 2> p = glyph.vertices.back();
    for (const std::array<std::uint8_t, 2>& q : glyph.vertices) {
        const bool straddles = (p[1] > row) != (q[1] > row);
        if (straddles) {
            const bool p_beyond = p[0] > column, q_beyond = q[0] > column;
            if (p_beyond && q_beyond) {
                inside = !inside;
            } else if (p_beyond || q_beyond) {
                inside ^= (q[1] > p[1]) != ((p[1] - y) * (q[0] - x) > (p[0] - x) * (q[1] - y));
            }
        }
        p = q;
    }
    return inside;
}

}  // namespace

TextLayout::TextLayout(const std::vector<std::string>& lines, std::shared_ptr<const Font> font,
                       const Vec3& origin, const Vec3& right, const Vec3& down,
                       std::optional<double> spacing)
    : font_(std::move(font)), origin_(origin) {
    assert(font_);
    const Vec3 normal = cross(down, right);
    const Vec3 columns = cross(normal, down), rows = cross(right, normal);
    if (!(length_squared(columns) > 1e-24 && length_squared(rows) > 0)) {
        throw InputError("illegal motion vector: right and down must span a plane");
    }
    right_ = columns * (length_squared(down) / length_squared(columns));
    down_ = rows * (length_squared(right) / length_squared(rows));
    if (spacing) cell_ = font_->mean_width + kCell * std::abs(*spacing);

    // Beyond a million cells nothing changes but the range of the integers.
    const auto gap =
        static_cast<std::int64_t>(std::clamp(kCell * spacing.value_or(0), -2.5e8, 2.5e8));
    for (const std::string& text : lines) {
        const Spacings spacings = gap == 0  ? uniform_spacings(*font_, text)
                                  : gap < 0 ? squeezed_spacings(*font_, text, -gap)
                                            : proportional_spacings(*font_, text, gap);
        Line line;
        line.text = text;
        for (std::size_t i = 0; i < text.size(); ++i) {
            line.width += spacings[i];
            line.pen.push_back(line.width);
            line.farthest.push_back(i == 0 ? line.width
                                           : std::max(line.width, line.farthest.back()));
        }
        line.width += spacings.back();
        lines_.push_back(std::move(line));
    }
}

bool TextLayout::inside(const Vec3& point) const {
    const Vec3 p = point - origin_;
    const double x = dot(p, right_) * cell_, y = dot(p, down_);
    if (!(x >= 0 && y >= 0 && y < static_cast<double>(lines_.size()))) return false;
    const auto row = static_cast<std::size_t>(y);
    const Line& line = lines_[row];
    if (!(x < static_cast<double>(line.width))) return false;
    const auto column = static_cast<std::int64_t>(x);
    if (column >= line.width) return false;
    const double fraction = x - static_cast<double>(column);
    const double height = (static_cast<double>(row + 1) - y) * kCell;
    // Characters are drawn until the first one whose cell begins beyond the point; cells may
    // overlap.
    const auto stop = std::upper_bound(line.farthest.begin(), line.farthest.end(), column);
    for (auto k = static_cast<std::size_t>(stop - line.farthest.begin()); k-- > 0;) {
        if (line.farthest[k] <= column - kCell) break;
        const std::int64_t offset = column - line.pen[k];
        const Font::Glyph& glyph = glyph_of(*font_, line.text[k]);
        if (offset >= kCell || glyph.vertices.empty()) continue;
        if (glyph_holds(glyph, static_cast<double>(offset) + fraction, height)) return true;
    }
    return false;
}

}  // namespace lightwalk
