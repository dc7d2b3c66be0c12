#pragma once
// Projection of the points of the cloud into a view.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "core/cloud/depth_grid.h"
#include "core/cloud/point.h"
#include "core/view/pixels.h"
#include "core/view/view.h"

namespace lightwalk {

/// A place in a picture.
struct ImagePlace {
    float x = -1, y = -1;  ///< from the lower left [pixels]
    float distance = 0;    ///< from the origin of the pixel's ray [m]; 0: outside the picture
};

/// The pixel that contains a place inside the picture.
[[nodiscard]] inline PixelPlace pixel_of(const ImagePlace& place, int width, int height) {
    // In single precision the right edge may round up to the width.
    return {std::min(static_cast<int>(place.x), width - 1),
            std::min(static_cast<int>(place.y), height - 1)};
}

/// Projects points to places in a picture of width x height pixels, for any view type.
class PointProjector {
  public:
    /// The camera must outlive this.
    PointProjector(const Camera& camera, int width, int height);

    /// The place of a point, without regard to what may hide it.
    [[nodiscard]] ImagePlace operator()(const Vec3& point) const;
    /// The places of many points; points that are gone get none.
    void operator()(std::span<const CloudPoint> points, std::span<ImagePlace> places) const;
    /// Whether the picture may show a point of a box. Of views that are not perspective: true.
    [[nodiscard]] bool may_show(const Vec3& lower, const Vec3& upper) const;
    [[nodiscard]] bool is_perspective() const { return perspective_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

  private:
    [[nodiscard]] ImagePlace in_perspective(const Vec3& point) const;

    const Camera& camera_;
    int width_, height_;
    bool perspective_;
    // For perspectives: image coordinates times depth [pixels m], and depth [m].
    Vec3 across_, upward_, forward_;
    double shift_ = 0, lift_ = 0;
    Vec3 eye_;
    double fore_ = 0, nearest_ = 0, farthest_ = HUGE_VAL;  ///< along the axis [m]
};

/// Project points first ... last - 1 and offer them to the grids, as far as these reach. Ranges may
/// be projected in any order or in parallel: the grids then hold the same winners.
/// @param places  one for each point of the cloud; those of the range are set
void project_points(const PointProjector& projector, std::span<const CloudPoint> points,
                    std::size_t first, std::size_t last, CloudGrids& grids,
                    std::span<ImagePlace> places);

}  // namespace lightwalk
