#pragma once
// Factories of textures, patterns and mixtures, one a family.
#include <memory>

#include "core/scene/modifier.h"

namespace lightwalk {

/// brightfunc, colorfunc: patterns computed by expressions.
[[nodiscard]] std::unique_ptr<const Modifier> make_function_pattern(const ModifierBuild& build);
/// brightdata, colordata: patterns interpolated from data files.
[[nodiscard]] std::unique_ptr<const Modifier> make_data_pattern(const ModifierBuild& build);
/// colorpict: a picture as a pattern.
[[nodiscard]] std::unique_ptr<const Modifier> make_picture_pattern(const ModifierBuild& build);
/// brighttext, colortext: text as a pattern.
[[nodiscard]] std::unique_ptr<const Modifier> make_text_pattern(const ModifierBuild& build);
/// texfunc: normal perturbation by expressions.
[[nodiscard]] std::unique_ptr<const Modifier> make_function_texture(const ModifierBuild& build);
/// texdata: normal perturbation from data files.
[[nodiscard]] std::unique_ptr<const Modifier> make_data_texture(const ModifierBuild& build);
/// mixfunc, mixdata, mixpict, mixtext.
[[nodiscard]] std::unique_ptr<const Modifier> make_mixture(const ModifierBuild& build);

}  // namespace lightwalk
