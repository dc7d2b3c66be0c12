#pragma once
// Where surfaces have come or gone between two frames of a walk.
#include <vector>

#include "core/cloud/point.h"
#include "core/geometry/geometry.h"

namespace lightwalk {

/// Boxes around surfaces that were there before or are there now. Points in them, or near them,
/// where shadows and light fall from surface to surface, and those that the eye sees past them may
/// show what is not there any more, and so may all that mirrors show.
class ChangedPlaces {
  public:
    /// @param surfaces  boxes around the surfaces, of which none is empty
    /// @param eye       of the next frame
    ChangedPlaces(const std::vector<Bounds>& surfaces, const Vec3& eye);

    [[nodiscard]] bool may_touch(const CloudPoint& point) const;

  private:
    struct Place {
        Bounds surfaces, around;
    };
    [[nodiscard]] bool touches(const Place& place, const Vec3& point) const;

    Place all_;
    std::vector<Place> places_;
    Vec3 eye_;
};

}  // namespace lightwalk
