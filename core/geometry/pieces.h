#pragma once
// Boxes for the search tree: one for each primitive, several for large polygons that fill theirs
// badly.
#include <cstdint>
#include <vector>

#include "core/geometry/model_primitives.h"

namespace lightwalk {

/// What the search tree holds: primitives, or parts of them. Parts of one primitive may overlap;
/// together they hold every point that ModelPrimitives::intersect can report.
struct Pieces {
    std::size_t whole = 0;  ///< pieces that are primitives; they come first
    /// Of each piece; empty where they are all whole, and follow each other from `first` on.
    std::vector<std::uint32_t> primitive_of;
    std::uint32_t first = 0;
    std::vector<Bounds> boxes;  ///< of the pieces that are parts

    [[nodiscard]] std::size_t size() const { return whole + boxes.size(); }
    [[nodiscard]] std::uint32_t primitive(std::size_t piece) const {
        return primitive_of.empty() ? first + static_cast<std::uint32_t>(piece)
                                    : primitive_of[piece];
    }
    [[nodiscard]] Bounds box(std::size_t piece, const ModelPrimitives& model) const {
        return piece < whole ? model.hit_bounds(primitive(piece)) : boxes[piece - whole];
    }
};

/// At least one piece for each finite primitive. Polygons with holes, slanted ones and triangles
/// are divided where most is won, so that a ray through a window does not have to be tested against
/// the wall around it, nor one in the attic against the roof. Idea: Stich, Friedrich & Dietrich,
/// "Spatial Splits in Bounding Volume Hierarchies", HPG 2009; here before the tree is built.
[[nodiscard]] Pieces divide_primitives(const ModelPrimitives& model, const Team& team);

}  // namespace lightwalk
