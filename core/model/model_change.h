#pragma once
// What may change in a scene whose surfaces stay where they are: its modifiers, and its sources at
// infinity (suns and skies).
#include <cstddef>
#include <memory>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// A surface as a primitive that owns its arguments.
[[nodiscard]] Primitive to_primitive(const SurfacePrimitive& surface);

/// A source at infinity, and its place among the scene's other surfaces.
struct PlacedSource {
    std::size_t before = 0;  ///< how many surfaces stand before it that are no sources
    Primitive source;        ///< its modifier is an index into ModelChange::modifiers
};

/// All modifiers and all sources at infinity of a model, as they are from now on. Those of models
/// that it places (octrees, meshes) stay as they are.
///
///     ModelChange change = unchanged(scene->model());
///     change.modifiers[wall].reals[0] = 0.8;
///     const Scene brighter(scene, change, modifier_factory, resources, warnings);
struct ModelChange {
    /// The model's own come first, by their indices; others may follow. Each refers only to earlier
    /// ones. Where there are fewer than the model has, the rest is as it was.
    std::vector<Primitive> modifiers;
    std::vector<PlacedSource> sources;  ///< in their order
};

/// The modifiers and sources that a model has.
[[nodiscard]] ModelChange unchanged(const Model& model);

/// Throws InputError for a change that nobody can have made of the model: one that comes from
/// another process may be anything.
void check_sound(const ModelChange& change, const Model& model);

/// The model with other modifiers and sources, as if it had been read so. Its other surfaces are
/// copied.
[[nodiscard]] std::shared_ptr<Model> changed_model(const Model& model, const ModelChange& change);

}  // namespace lightwalk
