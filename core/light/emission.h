#pragma once
// How bright light sources are, before anything is rendered.
#include <vector>

#include "core/light/light_sources.h"

namespace lightwalk {

/// Mean brightness of the radiance that each source sends into a few directions where it has
/// patterns, else of its material's [W/(m² sr)]. Above 0, but for virtual and unusable sources,
/// which are not asked.
[[nodiscard]] std::vector<float> mean_emissions(const LightSources& lights, const Tracer& tracer);

}  // namespace lightwalk
