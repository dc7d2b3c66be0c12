#pragma once
// Small polygons in the picture plane: area, width, and the part inside one pixel.
#include <array>
#include <cstddef>
#include <span>

namespace lightwalk {

struct ImagePoint {
    double x = 0, y = 0;
};

/// Up to kMax corners in order; x to the right, y up.
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
    /// Average of the corners.
    [[nodiscard]] ImagePoint center() const;
    /// The least over all edges of the largest distance of a corner from the edge's line.
    /// @param y_scale  how much longer a unit of y is than one of x
    [[nodiscard]] double width(double y_scale) const;
    /// Drop the corners that the others' outline holds already.
    void make_convex();
    /// The part inside [x0, x0 + 1] x [y0, y0 + 1]. Source: Sutherland & Hodgman, "Reentrant
    /// polygon clipping", CACM 17 (1974).
    [[nodiscard]] ImagePolygon clip_to_cell(int x0, int y0) const;

  private:
    /// Keep what is on the lower (keep_below) or upper side of the coordinate `limit`.
    [[nodiscard]] ImagePolygon clip(double ImagePoint::*axis, double limit, bool keep_below) const;

    std::array<ImagePoint, kMax> corner_;
    std::size_t count_ = 0;
};

}  // namespace lightwalk
