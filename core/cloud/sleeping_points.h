#pragma once
// Points that the picture does not show, kept until a view shows them again.
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "core/cloud/point.h"
#include "core/cloud/projection.h"
#include "core/cloud/shown_materials.h"
#include "core/geometry/geometry.h"

namespace lightwalk {

/// Groups of points that lie near each other. What is asleep costs a frame a look at the groups'
/// boxes only.
class SleepingPoints {
  public:
    /// Points that have left the picture.
    /// @param groups  what each light group adds to them, by point, then group; empty: not kept
    void add(std::span<const CloudPoint> points, std::span<const Rgb> groups = {});
    /// Take out all points that the picture may show, and others of their groups, those that fell
    /// asleep last first: of one place they tell most. Nothing is awake as one that the last frame
    /// has shown.
    /// @param awake  they are appended to these
    /// @param groups  the same of what add() had of them. Their radiance may be that of a mixture
    ///                of before
    /// @param most   once there are so many of `awake` the others sleep on
    void wake(const PointProjector& projector, std::size_t most, std::vector<CloudPoint>& awake,
              std::vector<Rgb>& groups);
    /// Forget those that may show some materials.
    void drop(const ShownMaterials& materials);
    /// Forget those that have slept longest, so that hardly more than `most` are left.
    void limit(std::size_t most);
    [[nodiscard]] std::size_t size() const { return size_; }

  private:
    struct Group {
        Bounds box;
        std::vector<CloudPoint> points;
        std::vector<Rgb> groups;
    };
    std::deque<Group> groups_;  ///< those that fell asleep first come first
    std::size_t size_ = 0;      ///< of all points
};

}  // namespace lightwalk
