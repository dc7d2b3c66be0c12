#pragma once
// Leaves of the search tree of a large model: up to eight BVH primitives, each with a box quantized
// to eight bytes. Such a tree takes a third of the memory of one whose leaves are single BVH
// primitives, and a ray tests the eight boxes of a leaf at once (SIMD). Source of the idea: Ylitie,
// Karras & Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG
// 2017.
#include <array>
#include <cstdint>
#include <span>

#include "core/geometry/bounds.h"

namespace lightwalk {

inline constexpr std::size_t kLeafSize = 8;

/// The one or two consecutive primitives of a BVH primitive, packed into 32 bits.
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
    /// Lower and upper corners of the boxes, in steps from `lower`: ten bits for each axis, x in
    /// the lowest.
    std::array<std::uint32_t, kLeafSize> begin{}, end{};
    std::array<PrimitiveRange, kLeafSize> bvh_primitives{};

    [[nodiscard]] Bounds box() const;  ///< around all boxes of the leaf, in the search coordinates
};

/// A ray in single precision, prepared for tests against many boxes.
struct LeafRay {
    std::array<float, 3> origin{}, inverse{};  ///< of the direction
    LeafRay(const std::array<float, 3>& from, const std::array<float, 3>& direction);
};

/// Factor of a ray's end before the entry into a box is compared with it: 1 plus 16 half units in
/// the last place, so that rounding loses no box.
inline constexpr float kEndRoundUp = 1 + 0x1p-20F;

/// The boxes of a leaf that a ray meets.
struct LeafHits {
    std::uint32_t met = 0;                 ///< a bit for each box that it meets up to its end
    std::array<float, kLeafSize> first{};  ///< where it enters each of those
};
/// Tests a ray against all boxes of a leaf. Conservative: no box is missed for rounding; unused
/// boxes may be reported as met.
[[nodiscard]] LeafHits boxes_met(const QuantizedLeaf& leaf, const LeafRay& ray, float end);

/// Make a leaf of up to kLeafSize BVH primitives, whose boxes have coordinates of single precision.
[[nodiscard]] QuantizedLeaf quantized_leaf(std::span<const Bounds> boxes,
                                           std::span<const PrimitiveRange> bvh_primitives);

}  // namespace lightwalk
