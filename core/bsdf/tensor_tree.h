#pragma once
// A tensor tree: a function on the unit cube of 3 or 4 dimensions that is constant in the cells of
// a tree. Source: Ward, Kurt & Bonneel, "A practical framework for sharing and rendering real-world
// bidirectional scattering distribution functions", LBNL-5954E (2012).
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// A node has 2^rank entries, one a child: bit i of a child's number is set where it takes the
/// upper half of dimension i. An entry is a value (a float >= 0, whose sign bit is clear), or the
/// number of another node with the highest bit set: four bytes a leaf, and as many an inner node.
class TensorTree {
  public:
    using Entry = std::uint32_t;
    static constexpr int kMostLevels = 20;  ///< how deep a tree may be
    static constexpr std::size_t kMostChildren = 16;

    TensorTree() = default;
    /// A tree of one cell; nodes are added from the leaves up.
    /// @param rank  3 or 4
    explicit TensorTree(int rank, float value = 0) : rank_(rank), root_(leaf(value)) {}
    /// The tree of given nodes, as nodes() and root() return them. They must be sound().
    TensorTree(int rank, std::vector<Entry> nodes, Entry root)
        : rank_(rank), nodes_(std::move(nodes)), root_(root) {}

    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] std::size_t children() const { return std::size_t{1} << rank_; }
    [[nodiscard]] Entry root() const { return root_; }
    [[nodiscard]] const std::vector<Entry>& nodes() const { return nodes_; }

    [[nodiscard]] static Entry leaf(float value) {
        return std::bit_cast<Entry>(value > 0 ? value : 0.0f);
    }
    [[nodiscard]] static bool is_leaf(Entry entry) { return !(entry & kNodeBit); }
    [[nodiscard]] static float value(Entry entry) { return std::bit_cast<float>(entry); }
    [[nodiscard]] Entry child(Entry node, std::size_t number) const {
        return nodes_[static_cast<std::size_t>(node & ~kNodeBit) * children() + number];
    }

    /// Add a node; the entry that stands for it.
    [[nodiscard]] Entry add(std::span<const Entry> children);
    /// Add a regular grid of 2^levels cells a side, whose last dimension runs fastest.
    [[nodiscard]] Entry add_grid(std::span<const float> values, int levels);
    void set_root(Entry root) { root_ = root; }

    /// Whether every entry is a value >= 0 or the number of an earlier node, none is deeper than
    /// kMostLevels, and all nodes are in one tree: what add() makes.
    [[nodiscard]] bool sound() const;

  private:
    static constexpr Entry kNodeBit = 0x80000000U;
    [[nodiscard]] Entry add_block(std::span<const float> values, int levels, int left,
                                  const std::array<std::size_t, 4>& corner);

    int rank_ = 4;
    std::vector<Entry> nodes_;
    Entry root_ = 0;
};

/// A coordinate in [0, 1) as the path of halves that leads to it.
class HalvingPath {
  public:
    HalvingPath() = default;
    explicit HalvingPath(double coordinate) {
        const double scaled = coordinate * (1 << kBits);
        bits_ = !(scaled > 0)               ? 0
                : scaled < (1 << kBits) - 1 ? static_cast<std::uint32_t>(scaled)
                                            : (1U << kBits) - 1;
    }
    /// 1 where it goes to the upper half at a level, from 0.
    [[nodiscard]] std::size_t half(int level) const { return (bits_ >> (kBits - 1 - level)) & 1U; }
    /// The number of the cell that holds it at a level.
    [[nodiscard]] std::uint32_t cell(int level) const {
        return level == 0 ? 0 : bits_ >> (kBits - level);
    }

  private:
    static constexpr int kBits = 30;
    std::uint32_t bits_ = 0;
};

/// What stands at a point of the cube.
struct TensorLeaf {
    float value = 0;
    int level = 0;  ///< the cell's edge is 2^-level
};
[[nodiscard]] TensorLeaf find_leaf(const TensorTree& tree, std::span<const HalvingPath> point);

}  // namespace lightwalk
