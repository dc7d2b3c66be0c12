#pragma once
// The text of brighttext, colortext and mixtext, placed in the scene.
#include "core/scene/modifier.h"
#include "core/texture/text_layout.h"

namespace lightwalk {

/// Lay out a text primitive whose font is string argument `font`; throws InputError for bad
/// arguments.
/// @param colors  how many reals stand between the three vectors and the optional spacing
[[nodiscard]] TextLayout make_text_layout(const ModifierBuild& build, std::size_t font,
                                          std::size_t colors);

/// Whether the hit lies inside a glyph; text of an instance is read in the instance's space.
[[nodiscard]] bool inside_text(const TextLayout& layout, const Ray& ray,
                               const TraceContext& context);

}  // namespace lightwalk
