#pragma once
// What a traced pixel leaves behind: the points of the cloud.
#include <array>
#include <cmath>
#include <cstdint>

#include "core/math/direction_code.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// How the light of a point came to the eye.
enum class PointKind : std::uint8_t {
    plain,     ///< straight from a surface that looks the same from all sides
    mirrored,  ///< by a mirror-like reflection: the point lies where the image is, behind the
               ///< mirror
    through,   ///< through panes
    glossy,    ///< from a surface that looks different from other sides
    gone,      ///< no point any more: the cloud drops it when the frame is done
};
inline constexpr std::uint8_t kPointKinds = 5;

/// Of light that takes no part in reuse: its colour holds from the traced direction alone.
inline constexpr float kAnyViewAngle = HUGE_VALF;

/// Where light came from, and how much. A pixel leaves up to two: what lies ahead, and what a
/// mirror-like surface adds to it.
struct CloudPoint {
    std::array<float, 3> position{};  ///< world; an image's behind its mirror; a background's 1e10
                                      ///< m away [m]
    Rgb radiance;                     ///< as traced, its share of the pixel [W/(m² sr)]
    std::uint32_t surface =
        0;  ///< what the light met on its way to the eye (see PrimaryVisibility::surface)
    std::uint32_t direction = 0;           ///< of the ray that saw it (encode_direction)
    float max_view_angle = kAnyViewAngle;  ///< how far that direction may turn before the colour is
                                           ///< wrong; see kAnyViewAngle [rad]
    PointKind kind = PointKind::plain;
    std::uint8_t age = 0;  ///< frames since it was last used
    std::uint8_t old = 0;  ///< frames since it was traced, at most 255
    bool paired = false;   ///< its pixel left two points, whose sum it shows

    [[nodiscard]] Vec3 place() const {
        return {static_cast<double>(position[0]), static_cast<double>(position[1]),
                static_cast<double>(position[2])};
    }
    friend bool operator==(const CloudPoint&, const CloudPoint&) = default;
};
static_assert(sizeof(CloudPoint) <= 40, "millions of points are kept");

/// Whether a point looks the same along the unit vector `direction`: it has not turned from the
/// ray that saw the point by more than `tightness` (0 ... 1) times what the point allows.
[[nodiscard]] inline bool holds_from(const CloudPoint& point, const Vec3& direction,
                                     double tightness) {
    if (point.max_view_angle == kAnyViewAngle) return true;
    const double most =
        static_cast<double>(point.max_view_angle) * tightness;  // chords are hardly shorter
    return length_squared(decode_direction(point.direction) - direction) <= most * most;
}

}  // namespace lightwalk
