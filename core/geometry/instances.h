#pragma once
// Nested placements, flattened: one frame for every path of placements that leads from the scene to
// a model.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/geometry.h"

namespace lightwalk {

/// A model as one path of placements shows it. Parents come before their children.
struct PlacedModel {
    Transform to_world;
    std::uint32_t model = 0;
    /// The outermost placement of the path whose modifier shades everything inside, and the frame
    /// that this modifier lives in; nothing when the contents keep their own modifiers.
    SurfaceId override_surface = kNoSurface;
    FrameId override_frame = kWorld;
};

/// Paths that a scene may hold: each costs about half a kilobyte.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

/// Total scale of a path of placements.
inline constexpr double kSmallestScale = 1e-7, kLargestScale = 1e7;

/// Frames of all paths that lead to geometry, indexed by FrameId. Throws InputError for more than
/// kMaxInstances paths, for models nested deeper than 1000, and for transforms that are not finite
/// or scale beyond these.
[[nodiscard]] std::vector<PlacedModel> flatten_placements(const GeometryInput& input);

}  // namespace lightwalk
