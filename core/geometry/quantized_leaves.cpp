#include "core/geometry/quantized_leaves.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lightwalk {
namespace {

constexpr unsigned kSideBits = 10;
constexpr std::uint32_t kMostSteps = (1U << kSideBits) - 1;
constexpr double kRoundUp = 1 + 0x1p-23;  ///< compensates for rounding to single precision

// Vectors of eight numbers (GCC vector extension), which the compiler maps to the SIMD width of the
// processor.
using Words = std::uint32_t __attribute__((vector_size(4 * kLeafSize)));
using Integers = std::int32_t __attribute__((vector_size(4 * kLeafSize)));
using Floats = float __attribute__((vector_size(4 * kLeafSize)));

// Results are passed through references: the calling convention of vector return values depends on
// the instruction set.

/// Unpacks one side of each box along axis k [steps].
[[gnu::always_inline]] inline void get_sides(const Words& words, std::size_t k, Floats& sides) {
    const Words along = (words >> (kSideBits * static_cast<unsigned>(k))) & kMostSteps;
    sides = __builtin_convertvector(__builtin_convertvector(along, Integers), Floats);
}

}  // namespace

QuantizedLeaf quantized_leaf(std::span<const Bounds> boxes,
                             std::span<const PrimitiveRange> bvh_primitives) {
    QuantizedLeaf leaf;
    Bounds all;
    for (const Bounds& box : boxes) extend(all, box);
    std::array<double, 3> steps{};
    for (std::size_t k = 0; k < 3; ++k) {
        // The range has one step more than needed, which is far more than rounding can lose.
        const double size = all.upper[k] - all.lower[k];
        leaf.step[k] = static_cast<float>(std::max(size / (kMostSteps - 1) * kRoundUp, 0x1p-100));
        leaf.lower[k] = static_cast<float>(all.lower[k]);
        steps[k] = static_cast<double>(leaf.step[k]);
    }
    // Unused boxes are inverted: they end before they begin.
    leaf.begin.fill(~std::uint32_t{0});
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Bounds& box = boxes[i];
        leaf.begin[i] = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const unsigned shift = kSideBits * static_cast<unsigned>(k);
            const double begin = (box.lower[k] - all.lower[k]) / steps[k],
                         end = (box.upper[k] - all.lower[k]) / steps[k] + 1;
            leaf.begin[i] |= std::min(static_cast<std::uint32_t>(begin), kMostSteps) << shift;
            leaf.end[i] |= std::min(static_cast<std::uint32_t>(end), kMostSteps) << shift;
        }
        leaf.bvh_primitives[i] = bvh_primitives[i];
    }
    return leaf;
}

Bounds QuantizedLeaf::box() const {
    Bounds bounds;
    for (std::size_t k = 0; k < 3; ++k) {
        bounds.lower[k] = static_cast<double>(lower[k]);
        bounds.upper[k] = bounds.lower[k] + kMostSteps * static_cast<double>(step[k]);
    }
    return bounds;
}

LeafRay::LeafRay(const std::array<float, 3>& from, const std::array<float, 3>& direction)
    : origin(from) {
    constexpr float kLeast = 1e-18F;
    for (std::size_t k = 0; k < 3; ++k)
        inverse[k] = 1 / std::copysign(std::max(std::abs(direction[k]), kLeast), direction[k]);
}

LeafHits boxes_met(const QuantizedLeaf& leaf, const LeafRay& ray, float end) {
    Words begins, ends;
    std::memcpy(&begins, leaf.begin.data(), sizeof begins);
    std::memcpy(&ends, leaf.end.data(), sizeof ends);
    Floats first{}, last = first + end, in, out;
    for (std::size_t k = 0; k < 3; ++k) {
        const bool forward = ray.inverse[k] > 0;
        const float start = (leaf.lower[k] - ray.origin[k]) * ray.inverse[k],
                    step = leaf.step[k] * ray.inverse[k];
        get_sides(forward ? begins : ends, k, in);
        get_sides(forward ? ends : begins, k, out);
        in = in * step + start;
        out = out * step + start;
        first = in > first ? in : first;
        last = out < last ? out : last;
    }
    constexpr Integers kBits{1, 2, 4, 8, 16, 32, 64, 128};
    const Integers met = (first <= last * kEndRoundUp) & kBits;
    LeafHits hits;
    std::memcpy(hits.first.data(), &first, sizeof first);
    for (std::size_t i = 0; i < kLeafSize; ++i) hits.met |= static_cast<std::uint32_t>(met[i]);
    return hits;
}

}  // namespace lightwalk
