#pragma once
// What the search tree of a large model ends in: up to eight bvh primitives side by side, with a
// box each in eight bytes. Against a tree that goes down to single bvh primitives this weighs a
// third, and a ray that meets a leaf tests its eight boxes at once. Idea: Ylitie, Karras & Laine,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017.
#include <array>
#include <cstdint>
#include <span>

#include "core/geometry/bounds.h"

namespace lightwalk {

inline constexpr std::size_t kLeafSize = 8;

/// Primitives that one box holds: one, or it and the next one.
class PrimitiveRange {
  public:
    PrimitiveRange() = default;
    PrimitiveRange(std::uint32_t first, std::uint32_t count) : bits_(2 * first + (count - 1)) {}
    [[nodiscard]] bool is_none() const { return bits_ == kNone; }
    [[nodiscard]] std::uint32_t first() const { return bits_ / 2; }
    [[nodiscard]] std::uint32_t end() const { return first() + 1 + bits_ % 2; }

  private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no model is so large
    std::uint32_t bits_ = kNone;
};

struct alignas(64) QuantizedLeaf {
    std::array<float, 3> lower{}, step{};  ///< in the search coordinates [m]
    /// Where the bvh primitives' boxes begin and end, in steps from `lower`: ten bits for each
    /// axis, that of x the lowest.
    std::array<std::uint32_t, kLeafSize> begin{}, end{};
    std::array<PrimitiveRange, kLeafSize> bvh_primitives{};

    [[nodiscard]] Bounds box() const;  ///< of all; in the search coordinates
};

/// A ray in single precision, made ready to be tested against many boxes.
struct LeafRay {
    std::array<float, 3> origin{}, inverse{};  ///< of the direction
    LeafRay(const std::array<float, 3>& from, const std::array<float, 3>& direction);
};

/// What the end of a ray in single precision is multiplied by before an entry is compared with it:
/// 16 half units in the last place.
inline constexpr float kEndRoundUp = 1 + 0x1p-20F;

/// What a ray meets of a leaf.
struct LeafHits {
    std::uint32_t met = 0;                 ///< a bit for each box that it meets up to its end
    std::array<float, kLeafSize> first{};  ///< where it enters each of those
};
/// Boxes are never missed for rounding; places without a bvh primitive may count as met.
[[nodiscard]] LeafHits boxes_met(const QuantizedLeaf& leaf, const LeafRay& ray, float end);

/// A leaf of up to kLeafSize bvh primitives; the sides of their boxes are numbers of single
/// precision.
[[nodiscard]] QuantizedLeaf quantized_leaf(std::span<const Bounds> boxes,
                                           std::span<const PrimitiveRange> bvh_primitives);

}  // namespace lightwalk
