#pragma once
// Points of the cloud: samples of radiance that traced pixels leave for later frames.
#include <array>
#include <cmath>
#include <cstdint>

#include "core/cloud/pattern_code.h"
#include "core/math/direction_code.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// How the light of a point came to the eye.
enum class PointKind : std::uint8_t {
    plain,     ///< directly from a surface that looks the same from all sides
    mirrored,  ///< by a mirror-like reflection: the point is the mirror image, behind the mirror
    through,   ///< through panes
    glossy,    ///< from a surface whose colour depends on the view direction
    gone,      ///< dropped: removed from the cloud at the end of the frame
};
inline constexpr std::uint8_t kPointKinds = 5;

/// Of PrimaryVisibility::surface: bits that are equal for surfaces of one material behind the same
/// kinds of panes and mirrors.
inline constexpr std::uint32_t kMaterialBits = 0xff;

/// Whether two surfaces are of one material and about as far away [m], as the leaves of a tree are.
[[nodiscard]] inline bool is_kin(std::uint32_t one, float one_distance, std::uint32_t other,
                                 float other_distance) {
    constexpr float kCrown = 0.25f;  // of a tree, as a share of its distance
    return ((one ^ other) & kMaterialBits) == 0 &&
           std::abs(one_distance - other_distance) <= kCrown * other_distance;
}

/// The view angle is not limited: the colour holds from all directions.
inline constexpr float kAnyViewAngle = HUGE_VALF;

/// A sample of radiance and the place that it came from. A pixel leaves up to two: of what lies
/// ahead, and of what a mirror-like surface reflects.
struct CloudPoint {
    std::array<float, 3> position{};  ///< world; a mirror image lies behind its mirror, the
                                      ///< background 1e10 m away [m]
    Rgb radiance;                     ///< as traced, its share of the pixel [W/(m² sr)]
    std::uint32_t surface =
        0;  ///< hash of the surfaces on the light's way (see PrimaryVisibility::surface)
    std::uint32_t direction = 0;  ///< of the ray that saw it (encode_direction)
    float max_view_angle =
        kAnyViewAngle;  ///< largest angle between that direction and another one for which the
                        ///< colour still holds; or kAnyViewAngle [rad]
    PointKind kind : 4 = PointKind::plain;
    bool paired : 1 = false;            ///< its pixel left two points, and shows their sum
    std::uint8_t age = 0;               ///< frames since it was last used
    std::uint8_t old = 0;               ///< frames since it was traced, at most 255
    std::uint8_t pattern = kNoPattern;  ///< of its surface there (encode_pattern)

    [[nodiscard]] Vec3 place() const {
        return {static_cast<double>(position[0]), static_cast<double>(position[1]),
                static_cast<double>(position[2])};
    }
    friend bool operator==(const CloudPoint&, const CloudPoint&) = default;
};
static_assert(sizeof(CloudPoint) <= 40, "millions of points are kept");

/// Whether the colour of a point holds for a ray along the unit vector `direction`: its angle to
/// the ray that saw the point is at most `tightness` (0 ... 1) times max_view_angle.
[[nodiscard]] inline bool holds_from(const CloudPoint& point, const Vec3& direction,
                                     double tightness) {
    if (point.max_view_angle == kAnyViewAngle) return true;
    const double most =
        static_cast<double>(point.max_view_angle) * tightness;  // chords are hardly shorter
    return length_squared(decode_direction(point.direction) - direction) <= most * most;
}

}  // namespace lightwalk
