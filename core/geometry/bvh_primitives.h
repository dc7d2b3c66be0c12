#pragma once
// The primitives of the bounding volume hierarchy (BVH): a primitive of the model, a pair of
// neighbours whose boxes nearly coincide, or a part of a large polygon or long cone, which would
// fill one box badly.
#include <cstdint>
#include <vector>

#include "core/geometry/model_primitives.h"

namespace lightwalk {

/// The BVH primitives of a model: first pairs of primitives, then single ones, then parts.
/// Parts of one primitive may overlap; together they hold every point that
/// ModelPrimitives::intersect can report.
struct BvhPrimitives {
    std::size_t pairs = 0;  ///< number of pairs: a primitive and the next one
    std::size_t whole = 0;  ///< number of pairs and single primitives
    /// The (first) primitive of each BVH primitive; empty where they are single primitives numbered
    /// from `first` on.
    std::vector<std::uint32_t> primitive_of;
    std::uint32_t first = 0;
    std::vector<Bounds> boxes;  ///< boxes of the parts

    [[nodiscard]] std::size_t size() const { return whole + boxes.size(); }
    [[nodiscard]] std::uint32_t primitive(std::size_t bvh_primitive) const {
        return primitive_of.empty() ? first + static_cast<std::uint32_t>(bvh_primitive)
                                    : primitive_of[bvh_primitive];
    }
    /// 2 for a pair of primitives, else 1.
    [[nodiscard]] std::uint32_t count(std::size_t bvh_primitive) const {
        return bvh_primitive < pairs ? 2 : 1;
    }
    [[nodiscard]] Bounds box(std::size_t bvh_primitive, const ModelPrimitives& model) const;
};

/// BVH primitives that cover every finite primitive of a model. In meshes and large models
/// consecutive primitives whose boxes nearly coincide, such as the two triangles of a grid cell,
/// become a pair, which halves the number of boxes. Polygons with holes, slanted polygons and
/// triangles are divided where that saves most surface area of boxes, slanted cones into slices
/// across their axis: a ray through a window then need not be tested against the wall around it.
/// Source of the idea: Stich, Friedrich & Dietrich, "Spatial Splits in Bounding Volume
/// Hierarchies", HPG 2009; here before the tree is built.
[[nodiscard]] BvhPrimitives divide_primitives(const ModelPrimitives& model,
                                              const TaskRunner& task_runner, bool slices = true);

}  // namespace lightwalk
