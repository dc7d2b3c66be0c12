#pragma once
// What the search tree of a large model ends in: up to eight pieces side by side, with a box each
// in eight bytes. Against a tree that goes down to single pieces this weighs a third, and a ray
// that meets a cluster tests its eight boxes at once. Idea: Ylitie, Karras & Laine, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017.
#include <array>
#include <cstdint>
#include <span>

#include "core/geometry/bounds.h"

namespace lightwalk {

inline constexpr std::size_t kClusterSize = 8;

/// Primitives that one box holds: one, or it and the next one.
class PieceRef {
  public:
    PieceRef() = default;
    PieceRef(std::uint32_t first, std::uint32_t count) : bits_(2 * first + (count - 1)) {}
    [[nodiscard]] bool is_none() const { return bits_ == kNone; }
    [[nodiscard]] std::uint32_t first() const { return bits_ / 2; }
    [[nodiscard]] std::uint32_t end() const { return first() + 1 + bits_ % 2; }

  private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no model is so large
    std::uint32_t bits_ = kNone;
};

struct alignas(64) Cluster {
    std::array<float, 3> lower{}, step{};  ///< in the search coordinates [m]
    /// Where the pieces' boxes begin and end, in steps from `lower`: ten bits for each axis, that
    /// of x the lowest.
    std::array<std::uint32_t, kClusterSize> begin{}, end{};
    std::array<PieceRef, kClusterSize> pieces{};

    [[nodiscard]] Bounds box() const;  ///< of all; in the search coordinates
};

/// A ray in single precision, made ready to be tested against many boxes.
struct ClusterRay {
    std::array<float, 3> origin{}, inverse{};  ///< of the direction
    ClusterRay(const std::array<float, 3>& from, const std::array<float, 3>& direction);
};

/// What the end of a ray in single precision is multiplied by before an entry is compared with it:
/// 16 half units in the last place.
inline constexpr float kEndRoundUp = 1 + 0x1p-20F;

/// What a ray meets of a cluster.
struct ClusterHits {
    std::uint32_t met = 0;                    ///< a bit for each box that it meets up to its end
    std::array<float, kClusterSize> first{};  ///< where it enters each of those
};
/// Boxes are never missed for rounding; places without a piece may count as met.
[[nodiscard]] ClusterHits boxes_met(const Cluster& cluster, const ClusterRay& ray, float end);

/// A cluster of up to kClusterSize pieces; the sides of their boxes are numbers of single
/// precision.
[[nodiscard]] Cluster cluster_of(std::span<const Bounds> boxes, std::span<const PieceRef> pieces);

}  // namespace lightwalk
