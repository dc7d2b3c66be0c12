#pragma once
// Boxes for the search tree: one for each primitive or for two that fill the same, several for
// large polygons and long cones that fill theirs badly.
#include <cstdint>
#include <vector>

#include "core/geometry/model_primitives.h"

namespace lightwalk {

/// What the search tree holds: pairs of primitives, primitives, and parts of them, in this order.
/// Parts of one primitive may overlap; together they hold every point that
/// ModelPrimitives::intersect can report.
struct BvhPrimitives {
    std::size_t pairs = 0;  ///< bvh primitives that are a primitive and the next one
    std::size_t whole = 0;  ///< bvh primitives that are no parts
    /// The first of each bvh primitive; empty where all are primitives that follow each other from
    /// `first` on.
    std::vector<std::uint32_t> primitive_of;
    std::uint32_t first = 0;
    std::vector<Bounds> boxes;  ///< of the bvh primitives that are parts

    [[nodiscard]] std::size_t size() const { return whole + boxes.size(); }
    [[nodiscard]] std::uint32_t primitive(std::size_t bvh_primitive) const {
        return primitive_of.empty() ? first + static_cast<std::uint32_t>(bvh_primitive)
                                    : primitive_of[bvh_primitive];
    }
    /// How many primitives a bvh primitive is (a part of).
    [[nodiscard]] std::uint32_t count(std::size_t bvh_primitive) const {
        return bvh_primitive < pairs ? 2 : 1;
    }
    [[nodiscard]] Bounds box(std::size_t bvh_primitive, const ModelPrimitives& model) const;
};

/// BvhPrimitives that hold every finite primitive. Neighbours in number whose boxes are nearly one,
/// such as the two triangles of a cell, are a pair in meshes and large models: half the boxes, and
/// a ray that meets one meets both. Polygons with holes, slanted ones and triangles are divided
/// where most is won, slanted cones by slices across their axis, so that a ray through a window
/// does not have to be tested against the wall around it, nor one in the attic against the roof.
/// Idea: Stich, Friedrich & Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG 2009;
/// here before the tree is built.
[[nodiscard]] BvhPrimitives divide_primitives(const ModelPrimitives& model,
                                              const TaskRunner& task_runner);

}  // namespace lightwalk
