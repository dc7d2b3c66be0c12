#pragma once
// Writes octree files.
#include <optional>
#include <string>
#include <vector>

#include "core/model/resources.h"
#include "io/scene/octree_tree.h"

namespace lightwalk {

struct OctreeOptions {
    std::vector<std::string> header;  ///< lines, without FORMAT and the empty one
    /// The cube; grown where it does not hold all surfaces, unless `strict`. Nothing: the smallest
    /// one around them.
    std::optional<ModelCube> cube;
    bool strict = false;  ///< a cube that does not hold all surfaces is an InputError
    TreeLimits limits;
};

/// An octree with all primitives of a model in it ("frozen"): modifiers, then surfaces. Any program
/// that reads octrees reads it. Numbers have 31 bits of mantissa, as octrees have. Files that
/// primitives name (functions, data, pictures, octrees, meshes) stay where they are.
/// @param resources  tells how large octrees and meshes are that the model places
/// @param warnings   told of surfaces that have no shape, and are no part of the tree
/// Throws InputError for wrong arguments of surfaces, missing octrees and meshes, and what an
/// octree cannot hold: more than 65535 words or numbers in a primitive, 511 surfaces in one place.
/// Source: Radiance's "File Formats" (1997), "Octrees".
[[nodiscard]] std::string encode_octree(const Model& model, Resources& resources,
                                        const OctreeOptions& options, WarningSink& warnings);

}  // namespace lightwalk
