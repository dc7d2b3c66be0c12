#pragma once
// Leaves of a search tree, grouped by Embree's BVH builder.
#include <vector>

#include "core/geometry/embree_search.h"

namespace lightwalk {

/// Groups all BVH primitives into leaves of up to kLeafSize. Returns none where the builder fails
/// (rtcGetDeviceError tells why). BVH primitives whose boxes are NaN are left out: no ray can hit
/// them.
[[nodiscard]] std::vector<QuantizedLeaf> make_quantized_leaves(const BvhPrimitives& bvh_primitives,
                                                               const ModelPrimitives& model,
                                                               const SearchSpace& space,
                                                               RTCDevice device,
                                                               const TaskRunner& task_runner);

}  // namespace lightwalk
