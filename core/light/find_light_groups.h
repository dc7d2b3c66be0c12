#pragma once
// Which modifiers of a scene emit light, and to which group each belongs.
#include <vector>

#include "core/light/light_group_pattern.h"
#include "core/scene/scene.h"
#include "core/transport/light_groups.h"
#include "core/transport/options.h"

namespace lightwalk {

/// Throws InputError for names that are empty, taken twice, kRestGroup or unfit for a file's name,
/// and for too many of them.
void check_group_names(const std::vector<LightGroupPattern>& wanted);

/// The modifiers that are named by surfaces which emit light, or may (mixtures of lights).
/// Textures and patterns are called by what they modify, and by their own names as well.
/// A modifier belongs to the first group that matches it, else to kRestGroup, which is there where
/// something belongs to it: also the constant -av.
/// @param wanted  empty: the usual groups: "sun" (sources at infinity of type light, less than 10
///                degrees wide), "sky" (other sources at infinity), and one for each other modifier
/// Throws InputError for a group without a modifier, and for more than kMostLightGroups.
[[nodiscard]] LightGroups find_light_groups(const Scene& scene, const RenderOptions& light,
                                            const std::vector<LightGroupPattern>& wanted);

}  // namespace lightwalk
