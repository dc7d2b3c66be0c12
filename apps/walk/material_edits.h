#pragma once
// Materials of a walk: what a surface is made of, and other numbers for it.
#include <cstddef>
#include <string>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/scene/scene.h"
#include "io/net/material_reply.h"

namespace lightwalk {

/// Other numbers for one of a model's modifiers.
struct ModifierEdit {
    std::size_t modifier = 0;  ///< into Model::modifiers
    std::vector<double> reals;
    friend bool operator==(const ModifierEdit&, const ModifierEdit&) = default;
};

/// What can be made of the page's edits.
struct CheckedEdits {
    std::vector<ModifierEdit> sound;  ///< in the order of the modifiers; none that changes nothing
    EditedReply reply;
};
/// @param built  the scene as it was read
[[nodiscard]] CheckedEdits check_edits(const Model& built, const EditsRequest& request);

/// The changed modifiers as a Radiance file.
/// @param edits  in the order of the modifiers
[[nodiscard]] std::string edited_materials(const Model& built,
                                           const std::vector<ModifierEdit>& edits);

/// What a surface is made of. A material that an octree or a mesh has brought cannot be changed.
/// @param scene  as it is shown
/// @param built  its own model as it was read
[[nodiscard]] MaterialReply describe_material(const Scene& scene, const Model& built,
                                              const Hit& hit, std::uint32_t id);

[[nodiscard]] Primitive edited_primitive(const Model& built, const ModifierEdit& edit);

/// The modifiers that differ between two lists of edits, each in the order of the modifiers.
[[nodiscard]] std::vector<std::size_t> changed_modifiers(const std::vector<ModifierEdit>& before,
                                                         const std::vector<ModifierEdit>& after);

/// Whether other numbers for one of these change the direct light on other surfaces: those of
/// what emits, and of what light passes or is mirrored by.
/// @param modifiers  of the scene's own
[[nodiscard]] bool lights_others(const Scene& scene, const std::vector<std::size_t>& modifiers);

/// The modifiers of a scene that show one of these: those themselves, and whatever is made of them.
/// @param edited  into the scene's own model
/// @return        by modifier
[[nodiscard]] std::vector<bool> modifiers_with(const Scene& scene,
                                               const std::vector<std::size_t>& edited);

}  // namespace lightwalk
