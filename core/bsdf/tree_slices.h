#pragma once
// The slices of a tensor tree: what stands over all exitant directions for one incident one.
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/bsdf/disk_square.h"
#include "core/bsdf/tensor_tree.h"

namespace lightwalk {

/// Which dimensions of a tree are the incident direction, over whose cells it is sliced.
struct SliceDimensions {
    int incident_first = 0, incident_count = 2, exitant_first = 2;

    /// The number of the child in the given halves: bit i belongs to dimension i of each.
    [[nodiscard]] std::size_t child(std::size_t incident, std::size_t exitant) const {
        return incident << incident_first | exitant << exitant_first;
    }
    [[nodiscard]] std::size_t incident_halves() const { return std::size_t{1} << incident_count; }
};

/// The paths of the incident coordinates; the second is not used where there is one.
using IncidentPath = std::array<HalvingPath, 2>;

/// Where a leaf of a slice lies on the exitant square.
struct SliceCell {
    std::uint32_t x = 0, y = 0;  ///< number of the cell of its level, from the lower left
    int level = 0;
    float value = 0;

    [[nodiscard]] double width() const {  // 2^-level
        return std::bit_cast<double>(static_cast<std::uint64_t>(1023 - level) << 52);
    }
    [[nodiscard]] double solid_angle() const { return kPi * width() * width(); }
    /// One of the four cells of the next level in it: bit i says which half of dimension i.
    [[nodiscard]] SliceCell quarter(std::uint32_t number) const {
        return {2 * x + (number & 1U), 2 * y + (number >> 1), level + 1, 0};
    }
};

/// Calls visit(SliceCell) for the leaves of a slice below an entry, in a fixed order; stops where
/// it returns false.
/// @param at  the entry's cell
template <class Visit>
bool visit_slice(const TensorTree& tree, const SliceDimensions& dimensions,
                 const IncidentPath& incident, TensorTree::Entry entry, const SliceCell& at,
                 const Visit& visit) {
    if (TensorTree::is_leaf(entry))
        return visit(SliceCell{at.x, at.y, at.level, TensorTree::value(entry)});
    std::size_t half = incident[0].half(at.level);
    if (dimensions.incident_count == 2) half |= incident[1].half(at.level) << 1;
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const TensorTree::Entry child = tree.child(entry, dimensions.child(half, quarter));
        if (!visit_slice(tree, dimensions, incident, child, at.quarter(quarter), visit))
            return false;
    }
    return true;
}

/// What one incident cell sees.
struct SliceSums {
    float total = 0;
    std::uint8_t coarsest = 255, finest = 0;  ///< levels of its leaves
};

constexpr int kBlockLevel = 3;  ///< sums are kept of blocks of this level of the exitant square
constexpr std::size_t kBlocks = std::size_t{1} << (2 * kBlockLevel);

/// The coarsest division of the incident interval or square in whose cells all directions have the
/// same slice, and sums of the slices. Built in time and memory proportional to the tree's nodes,
/// however uneven they are: leaves over many incident cells are added before these are divided.
/// Immutable but for forget_sums().
class IncidentCells {
  public:
    /// @param base  taken off all values, which do not go below 0
    IncidentCells(const TensorTree& tree, const SliceDimensions& dimensions, float base);
    /// The cell of an incident direction.
    [[nodiscard]] std::size_t find(const IncidentPath& incident) const;
    /// Of rank 3 the upper half of incident coordinates stands for no direction: nothing is seen.
    [[nodiscard]] const SliceSums& sums(std::size_t cell) const { return sums_[cell]; }
    /// The sums of a cell's first block, first two and so on, kBlocks of them.
    [[nodiscard]] const float* blocks(std::size_t cell) const { return &blocks_[cell * kBlocks]; }
    [[nodiscard]] bool has_sums() const { return !sums_.empty(); }
    [[nodiscard]] double largest_total() const { return largest_total_; }
    /// Level of the smallest leaf.
    [[nodiscard]] int finest() const { return finest_; }
    /// Forget sums and totals, but not finest().
    void forget_sums() {
        sums_ = {};
        blocks_ = {};
        largest_total_ = 0;
    }
    [[nodiscard]] std::size_t own_bytes() const {
        return nodes_.capacity() * sizeof(std::uint32_t) + sums_.capacity() * sizeof(SliceSums) +
               blocks_.capacity() * sizeof(float);
    }

  private:
    static constexpr std::uint32_t kNodeBit = 0x80000000U;
    /// A node or leaf over an incident cell, and the exitant cell over which it stands.
    struct Part {
        TensorTree::Entry entry;
        SliceCell at;
    };
    /// Sums of the leaves that stand over all of an incident cell.
    struct Running {
        std::array<double, kBlocks> blocks{};
        SliceSums levels;
        void add(const SliceCell& leaf, double value);
    };
    [[nodiscard]] std::uint32_t grow(const TensorTree& tree, const SliceDimensions& dimensions,
                                     float base, const std::vector<Part>& over, Running running,
                                     int level);
    [[nodiscard]] std::uint32_t add_cell(const Running& running);

    std::size_t halves_;                ///< children of a node: 2 or 4
    std::vector<std::uint32_t> nodes_;  ///< cells, or numbers of nodes with the highest bit set
    std::uint32_t root_ = 0;
    std::vector<SliceSums> sums_;  ///< one a cell
    std::vector<float> blocks_;    ///< kBlocks a cell
    int finest_ = 0;
    double largest_total_ = 0;
};

}  // namespace lightwalk
