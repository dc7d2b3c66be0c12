#include "core/bsdf/tree_slices.h"

#include <cmath>

namespace lightwalk {

IncidentCells::IncidentCells(const TensorTree& tree, const SliceDimensions& dimensions)
    : halves_(dimensions.incident_halves()) {
    root_ = grow(tree, dimensions, {tree.root()}, {0, 0}, 0);
    nodes_.shrink_to_fit();
}

/// Divides a cell as long as any entry over it is divided.
/// @param over  the nodes and leaves of the tree that lie over the cell, on all of the exitant
/// square
std::uint32_t IncidentCells::grow(const TensorTree& tree, const SliceDimensions& dimensions,
                                  const std::vector<TensorTree::Entry>& over,
                                  const std::array<double, 2>& corner, int level) {
    std::vector<TensorTree::Entry> divided;
    for (const TensorTree::Entry entry : over) {
        if (!TensorTree::is_leaf(entry)) divided.push_back(entry);
    }
    if (divided.empty()) {
        corners_.push_back({HalvingPath(corner[0]), HalvingPath(corner[1])});
        return static_cast<std::uint32_t>(corners_.size() - 1);
    }
    std::array<std::uint32_t, 4> children{};
    for (std::size_t half = 0; half < halves_; ++half) {
        std::vector<TensorTree::Entry> below;
        below.reserve(4 * divided.size());
        for (const TensorTree::Entry node : divided) {
            for (std::size_t quarter = 0; quarter < 4; ++quarter)
                below.push_back(tree.child(node, dimensions.child(half, quarter)));
        }
        const double width = std::ldexp(1.0, -level - 1);
        const std::array<double, 2> lower{corner[0] + width * static_cast<double>(half & 1),
                                          corner[1] + width * static_cast<double>(half >> 1)};
        children[half] = grow(tree, dimensions, below, lower, level + 1);
    }
    const auto number = static_cast<std::uint32_t>(nodes_.size() / halves_);
    nodes_.insert(nodes_.end(), children.begin(),
                  children.begin() + static_cast<std::ptrdiff_t>(halves_));
    return number | kNodeBit;
}

std::size_t IncidentCells::find(const IncidentPath& incident) const {
    std::uint32_t entry = root_;
    for (int level = 0; entry & kNodeBit; ++level) {
        std::size_t half = incident[0].half(level);
        if (halves_ == 4) half |= incident[1].half(level) << 1;
        entry = nodes_[(entry & ~kNodeBit) * halves_ + half];
    }
    return entry;
}

}  // namespace lightwalk
