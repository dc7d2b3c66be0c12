#include "core/math/direction_code.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kFieldScale = 11584.5;
constexpr unsigned kFieldMask = 0x1fff;
constexpr unsigned kFirstIsX = 1U << 3, kSecondIsZ = 1U << 4;
constexpr unsigned kFirstShift = 5, kSecondShift = 18;

/// Magnitude in steps of the code; anything that does not fit its field becomes the largest that
/// does.
unsigned quantize(double component) {
    const double steps = kFieldScale * std::abs(component) + 0.5;
    return steps < kFieldMask * 2.0 ? static_cast<unsigned>(steps) : kFieldMask;
}

}  // namespace

std::uint32_t encode_direction(const Vec3& unit) {
    const unsigned qx = quantize(unit.x), qy = quantize(unit.y), qz = quantize(unit.z);
    if (qx == 0 && qy == 0 && qz == 0) return 0;
    const unsigned smaller = std::min(qx, qy), larger = std::max(qx, qy);
    unsigned code = (unit.x < 0 ? 1U : 0U) | (unit.y < 0 ? 2U : 0U) | (unit.z < 0 ? 4U : 0U);
    if (qx <= qy) code |= kFirstIsX;
    if (qz <= larger) code |= kSecondIsZ;
    code |= (smaller & kFieldMask) << kFirstShift;
    code |= (std::min(qz, larger) & kFieldMask) << kSecondShift;
    return code == 0 ? 8 : code;
}

Vec3 decode_direction(std::uint32_t code) {
    if (code == 0) return {};
    const double a = (code >> kFirstShift & kFieldMask) / kFieldScale;
    const double b = (code >> kSecondShift & kFieldMask) / kFieldScale;
    const double c = std::sqrt(std::max(0.0, 1 - a * a - b * b));
    const bool second_is_z = (code & kSecondIsZ) != 0;
    const double z = second_is_z ? b : c, larger = second_is_z ? c : b;
    Vec3 d = (code & kFirstIsX) != 0 ? Vec3{a, larger, z} : Vec3{larger, a, z};
    if ((code & 1U) != 0) d.x = -d.x;
    if ((code & 2U) != 0) d.y = -d.y;
    if ((code & 4U) != 0) d.z = -d.z;
    return d;
}

}  // namespace lightwalk
