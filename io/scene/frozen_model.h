#pragma once
// Models and meshes as parts of a frozen scene: columns as they are in memory, the rest packed.
#include <cstdint>
#include <memory>

#include "core/geometry/surface_shapes.h"
#include "core/model/primitive.h"
#include "io/scene/frozen_parts.h"

namespace lightwalk {

/// @param shapes  of the model's surfaces
void freeze_model(const Model& model, const SurfaceShapes& shapes, std::uint32_t number,
                  FrozenParts& parts);
void freeze_mesh(const MeshModel& mesh, std::uint32_t number, FrozenParts& parts);

/// The model, whose columns show the file's bytes, and keep them. Throws InputError for what no
/// freeze_model can have written, in so far as a scene relies on it.
[[nodiscard]] std::shared_ptr<const Model> map_model(const FrozenFile& file, std::uint32_t number);
[[nodiscard]] std::shared_ptr<const MeshModel> map_mesh(const FrozenFile& file,
                                                        std::uint32_t number);

}  // namespace lightwalk
