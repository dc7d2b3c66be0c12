#pragma once
// Interface by which the cloud has rays cast: what pixels see (cheap), and their radiance (traced).
#include <cstdint>
#include <span>

#include "core/cloud/point.h"
#include "core/transport/light_groups.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Slope of a colour that holds for one ray only: it is never reused.
inline constexpr float kNeverReuse = HUGE_VALF;
/// Slope of a colour whose change with the eye's position cannot be predicted (curved mirrors,
/// refraction). It is reused only where the eye turns without moving.
inline constexpr float kMirrorLike = 100;

/// One place that a pixel's ray sees.
struct PrimaryVisibility {
    bool seen = false;
    Vec3 position;  ///< on the straight extension of the ray, at the length of the light's path;
                    ///< kHuge away for the background [m]
    float distance = 0;  ///< of the position from the ray's origin [m]
    std::uint32_t surface =
        0;  ///< hash of the sequence of surfaces that the light met, and of DataCells in panes
    PointKind kind = PointKind::plain;
    float slope =
        0;  ///< largest relative change of its colour per angle by which the ray turns [1/rad]; 0:
            ///< independent of the view direction; or kMirrorLike, kNeverReuse
    float pattern = 1;  ///< brightness of what patterns multiply its colour by, where asked for
};

/// What a pixel's ray sees: ahead (a surface, or what is seen through panes), and reflected by the
/// first surface. For a mirror `ahead` is not seen.
struct PixelVisibility {
    bool ray = false;    ///< false: outside the view's domain; the pixel is black
    Vec3 direction;      ///< of the ray, unit
    float x = 0, y = 0;  ///< where the ray goes through the picture [pixels from its lower left]
    PrimaryVisibility ahead, mirrored;
};

/// A traced pixel.
struct TracedPixel {
    PixelVisibility visibility;
    Rgb radiance;        ///< of the whole pixel [W/(m² sr)]
    Rgb mirrored;        ///< the part of it that belongs to visibility.mirrored
    float distance = 0;  ///< along the ray [m]
};

/// Of traced pixels, what each light group adds; by pixel, then group.
struct PixelGroups {
    std::span<const Rgb> whole;     ///< of TracedPixel::radiance; empty: not asked for
    std::span<const Rgb> mirrored;  ///< of TracedPixel::mirrored; zeros where it is not known
    const LightMixture* mixture = nullptr;  ///< that is shown; null where there are no groups
};

/// How pixels are probed.
struct ProbeOptions {
    bool patterns = false;  ///< whether patterns are asked for, which may take longer than all else
    int spacing = 1;  ///< more, 2 or 4: of pixels between others that see one plane, it is taken
                      ///< for granted that they see it, too (see SparseHits) [pixels]
};

/// Casts the rays of a frame. Many workers may call it at once, each with its own number.
class PixelCaster {
  public:
    virtual ~PixelCaster() = default;
    /// Find what the pixels' rays see, without shading (cheap). Slopes need only be right where
    /// they are kNeverReuse.
    /// @param places  those of a square of 8 x 8 pixels one after the other
    virtual void probe(std::span<const PixelPlace> places, const ProbeOptions& options,
                       std::span<PixelVisibility> visibility, int worker) = 0;
    /// Trace the pixels, with all of their visibility (expensive).
    /// @param sample  0: the rays that `probe` casts; 1, 2, ...: other rays of the same pixels,
    /// equally distributed
    virtual void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                       int sample, int worker) = 0;
    /// Of the pixels that the worker traced last.
    [[nodiscard]] virtual PixelGroups groups(int /*worker*/) const { return {}; }
};

/// The points that a traced pixel leaves: at most two.
/// @param tolerance  largest relative error of a pixel that reuses a point
struct PixelPoints {
    std::array<CloudPoint, 2> points;
    std::size_t count = 0;
};
[[nodiscard]] PixelPoints points_of(const TracedPixel& pixel, double tolerance);

}  // namespace lightwalk
