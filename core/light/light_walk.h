#pragma once
// Places in a scene that matter for its lighting: where light falls, directly and after diffuse
// reflections.
#include <vector>

#include "core/light/light_sources.h"

namespace lightwalk {

/// Follow light from the real sources to surfaces, and on from there in directions that are
/// distributed by the cosine to the normal (density cosθ / π), through whatever is transparent or a
/// light. Flat sources send by the cosine as well, others into all directions alike, distant ones
/// along their direction through the scene's bounding sphere. Seeded; at most a few thousand rays.
/// @param wanted  how many places; fewer are returned when light mostly leaves the scene
/// @return        hits with unit normals turned to the side that the light reached; one path after
///                the other, of up to three hits each, from one source after the other
[[nodiscard]] std::vector<Hit> walk_light(const LightSources& lights, const LightTransport& tracer,
                                          std::size_t wanted);

}  // namespace lightwalk
