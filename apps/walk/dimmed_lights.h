#pragma once
// Dimmers of a walk: from what the page sets to what is shown, and to a file of the scene.
#include <string>
#include <vector>

#include "core/model/primitive.h"
#include "core/transport/light_groups.h"
#include "io/net/walk_request.h"

namespace lightwalk {

/// Levels times colours, by group; those that are not named are as the scene has them. Names of
/// other groups are of a scene as it was before.
[[nodiscard]] LightMixture mixture_of(const LightsRequest& lights, const LightGroups& groups);

/// Of the scene's own modifiers those of all groups that are not as the scene has them, as a
/// Radiance file: each emits what the mixture shows of it.
[[nodiscard]] std::string scaled_lights(const std::vector<Primitive>& modifiers,
                                        const LightGroups& groups, const LightMixture& mixture);

}  // namespace lightwalk
