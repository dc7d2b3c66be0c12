#pragma once
// Makes the list of light sources from the surfaces of a scene that have light materials.
#include <vector>

#include "core/light/light_source.h"
#include "core/scene/scene.h"

namespace lightwalk {

/// The real light sources of a scene (not of its instances), in order: surfaces whose material is
/// light, illum, spotlight, or glow with a radius of influence, and every glow at infinity. Throws
/// InputError with the surface's file:line for shapes that cannot emit (cones, tubes, bubbles,
/// rings with a hole, polygons around whose centre there is nothing, zero sizes) and for wrong
/// material arguments; warns of shapes whose single sample is a poor estimate and of spotlights
/// that shine backwards. Source: the material and surface types of "The Radiance 6.x Scene
/// Description Language" (ray.pdf).
[[nodiscard]] std::vector<LightSource> collect_sources(const Scene& scene, WarningSink& warnings);

/// Whether a surface of the scene (not of its instances) has a glow that is not black.
[[nodiscard]] bool has_glow(const Scene& scene);

}  // namespace lightwalk
