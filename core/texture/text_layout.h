#pragma once
// Layout of lines of text on a plane.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/vec3.h"
#include "core/model/resources.h"

namespace lightwalk {

/// Text whose character cells are spanned by two motion vectors, as brighttext, colortext and
/// mixtext draw it. Source: Radiance's reference manual "ray.pdf", brighttext; the spacing rules
/// reproduce Radiance's.
class TextLayout {
  public:
    /// @param lines    from the top
    /// @param font     glyphs on a grid of 255 x 255 a cell
    /// @param origin   upper left corner of the first cell [m]
    /// @param right    from a cell to the next one [m]
    /// @param down     from a line to the next one [m]; need not be perpendicular to `right`
    /// @param spacing  0 or nothing: every character fills a cell; otherwise the gap between
    ///                 outlines in cells: negative: squeezed together, positive: squeezed and then
    ///                 aligned to columns again. A given spacing, even 0, scales the text to the
    ///                 font's mean width.
    /// Throws InputError `illegal motion vector` when right and down do not span a plane.
    TextLayout(const std::vector<std::string>& lines, std::shared_ptr<const Font> font,
               const Vec3& origin, const Vec3& right, const Vec3& down,
               std::optional<double> spacing = std::nullopt);

    /// Whether the point, moved along right x down onto the text's plane, lies on a character.
    [[nodiscard]] bool inside(const Vec3& point) const;

  private:
    struct Line {
        std::string text;
        std::vector<std::int64_t> pen;       ///< where each character's cell begins
        std::vector<std::int64_t> farthest;  ///< largest pen position up to each character
        std::int64_t width = 0;
    };
    std::shared_ptr<const Font> font_;
    std::vector<Line> lines_;
    Vec3 origin_, right_, down_;  ///< right_ and down_ turn a point into columns and lines
    double cell_ = 255;           ///< grid units a column
};

}  // namespace lightwalk
