#pragma once
// Clusters of bvh primitives, by Embree's builder.
#include <vector>

#include "core/geometry/embree_search.h"

namespace lightwalk {

/// Clusters that hold all bvh primitives; none where the builder fails, of which the device knows
/// more. BvhPrimitives whose boxes are no numbers are left out: nothing can hit them.
[[nodiscard]] std::vector<QuantizedLeaf> make_quantized_leaves(const BvhPrimitives& bvh_primitives,
                                                               const ModelPrimitives& model,
                                                               const SearchSpace& space,
                                                               RTCDevice device,
                                                               const TaskRunner& task_runner);

}  // namespace lightwalk
