#pragma once
// Tensor trees as XML files of BSDF data have them: { } for a node.
#include "core/bsdf/tensor_tree.h"
#include "io/bsdf/xml_text.h"

namespace lightwalk {

/// Read a whole element: a node holds either 2^rank nodes, child number c in the upper half of
/// dimension i where bit i of c is set, or the 2^(rank k) values of a regular grid, whose last
/// dimension runs fastest. Negative values become 0. Throws InputError `name:line: ...`.
[[nodiscard]] TensorTree read_tree(int rank, XmlNumbers& numbers);

}  // namespace lightwalk
