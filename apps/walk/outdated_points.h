#pragma once
// Which points of a walk a scene leaves standing that takes another one's place.
#include <optional>

#include "apps/walk/scene_follower.h"
#include "core/cloud/shown_materials.h"
#include "core/trace/tracer.h"

namespace lightwalk {

/// Points that show the new scene as well as the old one, but for indirect light, stay.
/// @param tracer  of the scene that the points are of
/// @param loaded  the model that it was read from
/// @param after   the scene that comes
/// @param eye     of the next frame
/// @return        those that may show what has changed; nothing: all may
[[nodiscard]] std::optional<ShownMaterials> outdated_points(const Tracer& tracer,
                                                            const Model& loaded, const Scene& after,
                                                            const SceneNews& news, const Vec3& eye);

}  // namespace lightwalk
