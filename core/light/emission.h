#pragma once
// How bright light sources are, before anything is rendered.
#include <vector>

#include "core/light/light_sources.h"

namespace lightwalk {

/// Brightness of each source [W/(m² sr)]: where it has patterns, the mean of the radiance Le that
/// it sends into a few directions, else that of its material. Above 0; 0 for virtual and unusable
/// sources, which are not measured.
[[nodiscard]] std::vector<float> mean_emissions(const LightSources& lights,
                                                const LightTransport& tracer);

}  // namespace lightwalk
