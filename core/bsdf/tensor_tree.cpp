#include "core/bsdf/tensor_tree.h"

namespace lightwalk {

TensorTree::Entry TensorTree::add(std::span<const Entry> children) {
    const auto number = static_cast<Entry>(nodes_.size() / children.size());
    nodes_.insert(nodes_.end(), children.begin(), children.end());
    return number | kNodeBit;
}

TensorTree::Entry TensorTree::add_grid(std::span<const float> values, int levels) {
    if (nodes_.empty()) {  // often the whole tree, of many values
        std::size_t entries = 0;
        for (int level = 1; level <= levels; ++level) entries += std::size_t{1} << (rank_ * level);
        nodes_.reserve(entries);
    }
    return add_block(values, levels, levels, {});
}

/// The part of a grid that begins at `corner` and is 2^left cells wide.
TensorTree::Entry TensorTree::add_block(std::span<const float> values, int levels, int left,
                                        const std::array<std::size_t, 4>& corner) {
    if (left == 0) {
        std::size_t at = 0;
        for (std::size_t d = 0; d < static_cast<std::size_t>(rank_); ++d)
            at = (at << levels) + corner[d];
        return leaf(values[at]);
    }
    std::array<Entry, kMostChildren> entries{};
    for (std::size_t c = 0; c < children(); ++c) {
        std::array<std::size_t, 4> part = corner;
        for (std::size_t d = 0; d < static_cast<std::size_t>(rank_); ++d)
            part[d] += (c >> d & 1U) << (left - 1);
        entries[c] = add_block(values, levels, left - 1, part);
    }
    return add(std::span(entries).first(children()));
}

bool TensorTree::sound() const {
    if (rank_ != 3 && rank_ != 4) return false;
    const std::size_t count = nodes_.size() / children();
    if (nodes_.size() % children() != 0 || count >= kNodeBit) return false;
    std::vector<int> height(count, 0);  // of the tree below each node
    std::vector<bool> used(count, false);
    const auto good = [&](Entry entry, std::size_t below, int& tallest) {
        if (is_leaf(entry)) return value(entry) <= 0x1p127f;  // which NaN is not
        const std::size_t node = entry & ~kNodeBit;
        if (node >= below || used[node]) return false;
        used[node] = true;
        tallest = tallest > height[node] ? tallest : height[node];
        return true;
    };
    for (std::size_t node = 0; node < count; ++node) {
        int tallest = 0;
        for (std::size_t c = 0; c < children(); ++c) {
            if (!good(nodes_[node * children() + c], node, tallest)) return false;
        }
        height[node] = tallest + 1;
        if (height[node] > kMostLevels) return false;
    }
    int tallest = 0;
    if (!good(root_, count, tallest)) return false;
    for (std::size_t node = 0; node < count; ++node) {
        if (!used[node]) return false;
    }
    return true;
}

TensorLeaf find_leaf(const TensorTree& tree, std::span<const HalvingPath> point) {
    TensorTree::Entry entry = tree.root();
    int level = 0;
    for (; !TensorTree::is_leaf(entry); ++level) {
        std::size_t number = 0;
        for (std::size_t d = 0; d < point.size(); ++d) number |= point[d].half(level) << d;
        entry = tree.child(entry, number);
    }
    return {TensorTree::value(entry), level};
}

}  // namespace lightwalk
