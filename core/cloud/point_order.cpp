#include "core/cloud/point_order.h"

#include <array>
#include <bit>

#include "core/math/random.h"

namespace lightwalk {
namespace {

/// All bytes of a point, which has no padding.
using PointBits = std::array<std::uint64_t, sizeof(CloudPoint) / sizeof(std::uint64_t)>;
static_assert(sizeof(PointBits) == sizeof(CloudPoint));

PointBits bits_of(const CloudPoint& point) {
    return std::bit_cast<PointBits>(point);
}

}  // namespace

bool precedes(const CloudPoint& a, const CloudPoint& b) {
    return bits_of(a) < bits_of(b);
}

std::uint32_t lot(const CloudPoint& point, std::uint64_t frame) {
    std::uint64_t mixed = mix_bits(frame + 1);
    for (const std::uint64_t bits : bits_of(point)) mixed = mix_bits(mixed ^ bits);
    return static_cast<std::uint32_t>(mixed >> 32);
}

}  // namespace lightwalk
