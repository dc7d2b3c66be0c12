#include "core/bsdf/tree_slices.h"

#include <algorithm>

namespace lightwalk {

IncidentCells::IncidentCells(const TensorTree& tree, const SliceDimensions& dimensions, float base)
    : halves_(dimensions.incident_halves()) {
    root_ = grow(tree, dimensions, base, {{tree.root(), {}}}, {}, 0);
    nodes_.shrink_to_fit();
    sums_.shrink_to_fit();
    blocks_.shrink_to_fit();
}

void IncidentCells::Running::add(const SliceCell& leaf, double value) {
    levels.coarsest = std::min(levels.coarsest, static_cast<std::uint8_t>(leaf.level));
    levels.finest = std::max(levels.finest, static_cast<std::uint8_t>(leaf.level));
    const double part = value * leaf.solid_angle();
    const int deeper = leaf.level - kBlockLevel;
    if (deeper >= 0) {
        blocks[(leaf.y >> deeper << kBlockLevel) + (leaf.x >> deeper)] += part;
        return;
    }
    const std::uint32_t side = 1U << -deeper;
    for (std::uint32_t y = leaf.y * side; y < (leaf.y + 1) * side; ++y) {
        for (std::uint32_t x = leaf.x * side; x < (leaf.x + 1) * side; ++x)
            blocks[(y << kBlockLevel) + x] += part / (side * side);
    }
}

/// Divides a cell as long as any entry over it is divided.
/// @param over     the nodes and leaves of the tree that lie over the cell, on all of the exitant
///                 square but for those leaves that are in `running`
std::uint32_t IncidentCells::grow(const TensorTree& tree, const SliceDimensions& dimensions,
                                  float base, const std::vector<Part>& over, Running running,
                                  int level) {
    std::vector<Part> divided;
    for (const Part& part : over) {
        if (TensorTree::is_leaf(part.entry)) {
            const float value = std::max(0.0f, TensorTree::value(part.entry) - base);
            running.add(part.at, static_cast<double>(value));
        } else {
            divided.push_back(part);
        }
    }
    if (divided.empty()) return add_cell(running);
    std::array<std::uint32_t, 4> children{};
    for (std::size_t half = 0; half < halves_; ++half) {
        const bool unused = halves_ == 2 && level == 0 && half == 1;
        std::vector<Part> below;
        if (!unused) below.reserve(4 * divided.size());
        for (const Part& node : divided) {
            for (std::uint32_t quarter = 0; quarter < 4 && !unused; ++quarter) {
                below.push_back({tree.child(node.entry, dimensions.child(half, quarter)),
                                 node.at.quarter(quarter)});
            }
        }
        children[half] = grow(tree, dimensions, base, below, running, level + 1);
    }
    const auto number = static_cast<std::uint32_t>(nodes_.size() / halves_);
    nodes_.insert(nodes_.end(), children.begin(),
                  children.begin() + static_cast<std::ptrdiff_t>(halves_));
    return number | kNodeBit;
}

std::uint32_t IncidentCells::add_cell(const Running& running) {
    SliceSums sums = running.levels;
    double sum = 0;
    for (const double block : running.blocks) blocks_.push_back(static_cast<float>(sum += block));
    sums.total = static_cast<float>(sum);
    largest_total_ = std::max(largest_total_, sum);
    finest_ = std::max(finest_, int{sums.finest});
    sums_.push_back(sums);
    return static_cast<std::uint32_t>(sums_.size() - 1);
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
