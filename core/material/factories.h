#pragma once
// Factories of materials, one a family. Each throws InputError for bad arguments.
#include <memory>

#include "core/scene/modifier.h"

namespace lightwalk {

/// plastic, metal, trans: isotropic, rough or smooth.
[[nodiscard]] std::unique_ptr<const Modifier> make_plastic(const ModifierBuild& build);
/// plastic2, metal2, trans2: brushed.
[[nodiscard]] std::unique_ptr<const Modifier> make_anisotropic(const ModifierBuild& build);
/// ashik2: the Ashikhmin-Shirley model.
[[nodiscard]] std::unique_ptr<const Modifier> make_ashikhmin(const ModifierBuild& build);
/// dielectric, interface: the boundary of a solid or liquid that refracts and absorbs.
[[nodiscard]] std::unique_ptr<const Modifier> make_dielectric(const ModifierBuild& build);
/// glass: a thin pane.
[[nodiscard]] std::unique_ptr<const Modifier> make_glass(const ModifierBuild& build);
/// mirror: a flat reflector that also relays light sources.
[[nodiscard]] std::unique_ptr<const Modifier> make_mirror(const ModifierBuild& build);
/// prism1, prism2: light redirected by expressions.
[[nodiscard]] std::unique_ptr<const Modifier> make_prism(const ModifierBuild& build);
/// mist: the boundary of a participating medium.
[[nodiscard]] std::unique_ptr<const Modifier> make_mist(const ModifierBuild& build);
/// antimatter: a volume cut out of others.
[[nodiscard]] std::unique_ptr<const Modifier> make_antimatter(const ModifierBuild& build);
/// light, illum, glow, spotlight: emission, seen by a ray that hits the source.
[[nodiscard]] std::unique_ptr<const Modifier> make_light(const ModifierBuild& build);
/// plasfunc, metfunc, transfunc, plasdata, metdata, transdata: a lobe given by a function or a
/// table.
[[nodiscard]] std::unique_ptr<const Modifier> make_function_brdf(const ModifierBuild& build);
/// BRTDfunc: everything given by expressions.
[[nodiscard]] std::unique_ptr<const Modifier> make_brtdfunc(const ModifierBuild& build);

}  // namespace lightwalk
