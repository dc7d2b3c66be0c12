#pragma once
// What the cloud asks of whoever casts rays: what pixels see, and what they look like.
#include <cstdint>
#include <span>

#include "core/cloud/point.h"
#include "core/math/function_ref.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Of things whose colour holds for one ray only: nothing of them is reused.
inline constexpr float kNeverReuse = HUGE_VALF;
/// Of things that change nobody knows how when the eye moves: curved mirrors, refraction. Eyes that
/// only turn see them as they were.
inline constexpr float kMirrorLike = 100;

/// One thing that a pixel's ray sees.
struct PrimaryVisibility {
    bool seen = false;
    Vec3 position;              ///< on the ray, as far along it as the light has come; where there
                                ///< is nothing, kHuge away [m]
    float distance = 0;         ///< of that from the ray's origin [m]
    std::uint32_t surface = 0;  ///< what the light met: of two rays that met the same surfaces in
                                ///< the same order the same number, of others another one
    PointKind kind = PointKind::plain;
    float slope = 0;  ///< relative change of its colour as the ray turns, at most [1/rad];
                      ///< 0: it looks the same from everywhere; kNeverReuse: who knows
};

/// What a pixel's ray sees: what lies ahead (a surface, or what shows through panes), and what the
/// first surface mirrors. A mirror has nothing ahead.
struct PixelVisibility {
    bool ray = false;    ///< false: outside the view's domain; the pixel is black
    Vec3 direction;      ///< of the ray, unit
    float x = 0, y = 0;  ///< where the ray goes through the picture [pixels from its lower left]
    PrimaryVisibility ahead, mirrored;
};

/// A pixel traced.
struct TracedPixel {
    PixelVisibility visibility;
    Rgb radiance;        ///< of the whole pixel [W/(m² sr)]
    Rgb mirrored;        ///< the part of it that belongs to visibility.mirrored
    float distance = 0;  ///< along the ray [m]
};

/// The caster of rays. Many workers call it at once, each with its own number.
struct PixelCaster {
    /// Cheap: what the pixels' rays see. Of slopes only kNeverReuse counts.
    FunctionRef<void(std::span<const PixelPlace> places, std::span<PixelVisibility> visibility,
                     int worker)>
        probe;
    /// Dear: the pixels themselves, with the same visibility.
    /// @param sample  0: the rays that were looked along; 1, 2, ...: others through the same
    /// pixels,
    ///                as good as these
    FunctionRef<void(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int sample,
                     int worker)>
        trace;
};

/// The points that a traced pixel leaves: at most two.
/// @param tolerance  how far the pixel may be off for a point to be reused, as a share of it
struct PixelPoints {
    std::array<CloudPoint, 2> points;
    std::size_t count = 0;
};
[[nodiscard]] PixelPoints points_of(const TracedPixel& pixel, double tolerance);

}  // namespace lightwalk
