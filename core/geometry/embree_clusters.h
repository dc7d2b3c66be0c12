#pragma once
// Clusters of pieces, by Embree's builder.
#include <vector>

#include "core/geometry/embree_search.h"

namespace lightwalk {

/// Clusters that hold all pieces; none where the builder fails, of which the device knows more.
/// Pieces whose boxes are no numbers are left out: nothing can hit them.
[[nodiscard]] std::vector<Cluster> make_clusters(const Pieces& pieces, const ModelPrimitives& model,
                                                 const SearchSpace& space, RTCDevice device,
                                                 const Team& team);

}  // namespace lightwalk
