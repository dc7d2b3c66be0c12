#pragma once
// Boxes for the search tree: one for each primitive, several for large polygons that fill theirs
// badly.
#include <cstdint>
#include <vector>

#include "core/geometry/model_primitives.h"

namespace lightwalk {

/// A part of a primitive. Parts of one primitive may overlap; together they hold every point that
/// ModelPrimitives::intersect can report.
struct Piece {
    std::uint32_t primitive = 0;
    Bounds box;
};

/// At least one piece for each primitive. Polygons with holes, slanted ones and triangles are
/// divided where most is won, so that a ray through a window does not have to be tested against the
/// wall around it, nor one in the attic against the roof. Idea: Stich, Friedrich & Dietrich,
/// "Spatial Splits in Bounding Volume Hierarchies", HPG 2009; here before the tree is built.
[[nodiscard]] std::vector<Piece> divide_primitives(const ModelPrimitives& model);

}  // namespace lightwalk
