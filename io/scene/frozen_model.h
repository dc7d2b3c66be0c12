#pragma once
// Models and meshes as parts of a frozen scene: columns in their form in memory, the rest
// serialised.
#include <cstdint>
#include <memory>

#include "core/geometry/surface_shapes.h"
#include "core/model/primitive.h"
#include "io/scene/frozen_parts.h"

namespace lightwalk {

/// Add a model to the parts of a frozen scene.
/// @param shapes  the shapes of the model's surfaces
void freeze_model(const Model& model, const SurfaceShapes& shapes, std::uint32_t number,
                  FrozenParts& parts);
void freeze_mesh(const MeshModel& mesh, std::uint32_t number, FrozenParts& parts);

/// A model of a frozen scene. Its columns refer to the file's bytes, and keep them alive. Throws
/// InputError for contents that freeze_model() cannot have written, as far as a scene relies on
/// them.
[[nodiscard]] std::shared_ptr<const Model> map_model(const FrozenFile& file, std::uint32_t number);
[[nodiscard]] std::shared_ptr<const MeshModel> map_mesh(const FrozenFile& file,
                                                        std::uint32_t number);

}  // namespace lightwalk
