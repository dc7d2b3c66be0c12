#pragma once
// What the rays of a plan, or of a grid of measuring points, meet: surfaces that the eye sees.
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/function_ref.h"
#include "core/scene/scene.h"

namespace lightwalk {

/// How a plan shows a surface.
enum class PlanLook : std::uint8_t {
    absent,  ///< not at all: invisible, or antimatter
    pane,    ///< light passes through it
    solid,
};

/// Where a line crosses a surface.
struct PlanCrossing {
    double t = 0;  ///< along the line [m]
    PlanLook look = PlanLook::solid;
    bool inward = false;  ///< the line comes from where the surface's normal points
};

/// Casts the rays of a plan. Immutable; many threads may use it at once.
class PlanSight {
  public:
    /// @param scene       must outlive this
    /// @param back_faces  whether surfaces are seen from behind
    PlanSight(const Scene& scene, bool back_faces);

    [[nodiscard]] Bounds bounds() const { return scene_.geometry().bounds(); }
    /// The crossings of a line with what can be seen, in order: at most 128, none closer than
    /// `apart` to the one before.
    /// @param along  unit
    void follow(const Vec3& from, const Vec3& along, double length, double apart,
                FunctionRef<void(const PlanCrossing&)> take) const;
    /// The first thing that can be seen along a line; exists() is false where nothing is within
    /// `length`.
    /// @param along  unit
    [[nodiscard]] Hit first(const Vec3& from, const Vec3& along, double length) const;
    /// The first thing that can be seen straight below each of some places; hits[i].exists() is
    /// false where there is nothing.
    void look_down(std::span<const Vec3> places, std::span<Hit> hits) const;

  private:
    [[nodiscard]] PlanLook look_of(const Hit& hit) const;

    const Scene& scene_;
    bool back_faces_;
    std::vector<PlanLook> looks_;  ///< by modifier
};

}  // namespace lightwalk
