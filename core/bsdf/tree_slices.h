#pragma once
// The slices of a tensor tree: what stands over all exitant directions for one incident one.
#include <array>
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

    [[nodiscard]] double width() const { return std::ldexp(1.0, -level); }
    [[nodiscard]] double solid_angle() const { return kPi * width() * width(); }
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
        const SliceCell part{2 * at.x + (quarter & 1U), 2 * at.y + (quarter >> 1), at.level + 1, 0};
        const TensorTree::Entry child = tree.child(entry, dimensions.child(half, quarter));
        if (!visit_slice(tree, dimensions, incident, child, part, visit)) return false;
    }
    return true;
}

/// The coarsest division of the incident interval or square in whose cells all directions have the
/// same slice. Immutable.
class IncidentCells {
  public:
    IncidentCells(const TensorTree& tree, const SliceDimensions& dimensions);
    [[nodiscard]] std::size_t size() const { return corners_.size(); }
    /// The cell of an incident direction.
    [[nodiscard]] std::size_t find(const IncidentPath& incident) const;
    /// An incident direction of the cell.
    [[nodiscard]] const IncidentPath& corner(std::size_t cell) const { return corners_[cell]; }
    /// Forget the corners: they are needed while sums are made.
    void forget_corners() { corners_ = {}; }
    [[nodiscard]] std::size_t own_bytes() const {
        return nodes_.capacity() * sizeof(std::uint32_t) +
               corners_.capacity() * sizeof(IncidentPath);
    }

  private:
    static constexpr std::uint32_t kNodeBit = 0x80000000U;
    [[nodiscard]] std::uint32_t grow(const TensorTree& tree, const SliceDimensions& dimensions,
                                     const std::vector<TensorTree::Entry>& over,
                                     const std::array<double, 2>& corner, int level);

    std::size_t halves_;                ///< children of a node: 2 or 4
    std::vector<std::uint32_t> nodes_;  ///< cells, or numbers of nodes with the highest bit set
    std::uint32_t root_ = 0;
    std::vector<IncidentPath> corners_;
};

}  // namespace lightwalk
