#pragma once
// Small polygons in the picture plane: area, width, and the part inside one pixel.
#include <array>
#include <cstddef>
#include <span>

namespace lightwalk {

struct ImagePoint {
    double x = 0, y = 0;
};

/// A polygon in the picture plane: up to kMax corners in order, x to the right, y up.
class ImagePolygon {
  public:
    static constexpr std::size_t kMax = 16;

    void add(const ImagePoint& p) {
        if (count_ < kMax) corner_[count_++] = p;
    }
    void remove(std::size_t i);
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] const ImagePoint& operator[](std::size_t i) const { return corner_[i % count_]; }
    [[nodiscard]] double area() const;
    /// The average of the corners.
    [[nodiscard]] ImagePoint center() const;
    /// The polygon's width where it is narrowest: the largest distance of a corner from the line of
    /// an edge, for the edge where that is least.
    /// @param y_scale  how much longer a unit of y is than one of x
    [[nodiscard]] double width(double y_scale) const;
    /// Make the polygon its convex hull: drop the corners that lie inside.
    void make_convex();
    /// The part inside [x0, x0 + 1] x [y0, y0 + 1]. Source: Sutherland & Hodgman, "Reentrant
    /// polygon clipping", CACM 17 (1974).
    [[nodiscard]] ImagePolygon clip_to_cell(int x0, int y0) const;

  private:
    /// The part on one side of a line where a coordinate is `limit`: below it, or above.
    [[nodiscard]] ImagePolygon clip(double ImagePoint::*axis, double limit, bool keep_below) const;

    std::array<ImagePoint, kMax> corner_;
    std::size_t count_ = 0;
};

}  // namespace lightwalk
