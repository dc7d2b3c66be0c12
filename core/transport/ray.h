#pragma once
// A ray, what it inherits from the rays before it, and what it brings back.
#include <cstdint>

#include "core/geometry/geometry.h"
#include "core/math/distance.h"
#include "core/math/random.h"
#include "core/math/rgb.h"
#include "core/model/ids.h"

namespace lightwalk {

/// Kinds of rays; the history of a path is the union of its kinds.
enum RayKind : std::uint16_t {
    kPrimary = 1,
    kReflected = 2,  ///< mirror-like
    kRefracted = 4,
    kTransferred = 8,     ///< straight on, or bent by a material
    kShadowSame = 16,     ///< to a source on the viewer's side
    kShadowThrough = 32,  ///< to a source through the surface
    kAmbientSame = 64,
    kAmbientThrough = 128,
    kSpecularReflected = 256,    ///< sampled rough reflection
    kSpecularTransmitted = 512,  ///< sampled rough transmission

    kShadow = kShadowSame | kShadowThrough,
    kAmbient = kAmbientSame | kAmbientThrough,
    kSpecular = kSpecularReflected | kSpecularTransmitted,
    /// Kinds that stay on the viewer's side. A light candidate is kShadow (both bits) and counts as
    /// such.
    kSameSide = kShadowSame | kReflected | kAmbientSame | kSpecularReflected,
};

struct ClipSet;      ///< immutable; lives in the TraceContext's PathState
struct ScatterList;  ///< immutable; lives there, or in LightSources

/// Participating medium of a ray segment.
struct Medium {
    Rgb extinction;  ///< [1/m]
    Rgb albedo;
    float eccentricity = 0;                ///< g of Henyey and Greenstein's phase function
    const ScatterList* scatter = nullptr;  ///< sources that are scattered; null: none
};

struct Ray;

/// A ray's place in its path.
struct RayPath {
    const Ray* parent = nullptr;  ///< null: a primary ray
    Rgb coef{1, 1, 1};            ///< factor of the ray's radiance in its parent's
    double weight = 1;            ///< bound on the path's throughput, from the primary ray on
    int level = 0;                ///< reflections so far
    std::uint16_t kind = kPrimary;
    std::uint16_t history = kPrimary;
    double path_length = 0;    ///< of all ancestors back to the primary ray [m]
    double shadow_length = 0;  ///< of the directly preceding shadow-ray ancestors [m]
    RandomStream random;

    [[nodiscard]] bool in(std::uint16_t kinds) const { return (history & kinds) != 0; }
};

/// What a ray passes through.
struct RaySurroundings {
    Medium medium;
    const ClipSet* clip = nullptr;       ///< surfaces that do not exist for the ray; null: none
    const ClipSet* next_clip = nullptr;  ///< for rays that go on through the hit surface
};

/// What a ray brings back.
struct RayRadiance {
    Rgb value;                             ///< Li: radiance that arrives along the ray [W/(m² sr)]
    Rgb mirrored;                          ///< the part of it that came by mirror-like reflection
    double reflected_path_length = kHuge;  ///< to what is seen in the mirror; Radiance's rmt [m]
    double unreflected_path_length = kHuge;  ///< to what is seen otherwise; Radiance's rxt [m]

    /// Distance of what is seen: through or in a mirror-like surface where that dominates [m].
    [[nodiscard]] double effective_distance() const {
        return brightness(mirrored) > 0.5f * brightness(value) ? reflected_path_length
                                                               : unreflected_path_length;
    }
};

inline constexpr std::int32_t kNoTarget = -1;

struct Ray : RayPath, RaySurroundings, RayRadiance {
    Vec3 origin, direction;           ///< direction is unit, away from the viewer: wi = direction
    double limit = 0;                 ///< aft clipping distance; 0: none [m]
    std::int32_t target = kNoTarget;  ///< light source (index) aimed at
    bool aimed = false;    ///< evaluate the target's radiance alone: only its own object exists
    Hit hit;               ///< nearest hit; for nothing or a distant source t = kHuge
    Rgb pattern{1, 1, 1};  ///< product of the patterns met; textures add to hit.perturbation

    /// The way to the farthest hit that counts.
    [[nodiscard]] RaySegment segment() const { return {origin, direction, farthest_hit(limit)}; }
    /// Whether a texture moved the normal (|d| > kEpsilon).
    [[nodiscard]] bool perturbed() const {
        return length_squared(hit.perturbation) > kEpsilon * kEpsilon;
    }
};

}  // namespace lightwalk
