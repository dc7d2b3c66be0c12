#pragma once
// Where surfaces have come or gone between two frames of a walk.
#include <vector>

#include "core/cloud/point.h"
#include "core/geometry/geometry.h"

namespace lightwalk {

/// A place where light comes from that casts shadows: one of several of a large lamp.
struct ShadowSource {
    Vec3 place;            ///< [m]; a distant one's unit direction
    bool distant = false;  ///< at infinity
};

/// Boxes around surfaces that were there before or are there now. Points in them, or near them,
/// where light falls from surface to surface, those that the eye sees past them, and those in their
/// shadows may show what is not there any more, and so may all that mirrors show.
class ChangedPlaces {
  public:
    /// @param surfaces  boxes around the surfaces, of which none is empty
    /// @param eye       of the next frame
    /// @param sources   whose shadows count
    ChangedPlaces(const std::vector<Bounds>& surfaces, const Vec3& eye,
                  std::vector<ShadowSource> sources);

    [[nodiscard]] bool may_touch(const CloudPoint& point) const;

  private:
    struct Place {
        Bounds surfaces, around;
    };
    [[nodiscard]] bool touches(const Place& place, const Vec3& point) const;
    [[nodiscard]] static bool shades(const Place& place, const Vec3& point,
                                     const ShadowSource& source);

    Place all_;
    std::vector<Place> places_;
    Vec3 eye_;
    std::vector<ShadowSource> sources_;
};

}  // namespace lightwalk
