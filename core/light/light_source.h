#pragma once
// One light source, real or virtual, as the direct calculation samples it.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/light/virtual_source_beam.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"
#include "core/model/ids.h"
#include "core/model/primitive.h"

namespace lightwalk {

/// A spotlight's cone, or the beam of a virtual distant source.
struct SpotShape {
    Vec3 aim;                ///< unit axis of a cone; a point on the axis of a beam
    float size = 0;          ///< solid angle of the cone [sr]; cross-section of a beam [m²]
    float focal_length = 0;  ///< distance of the cone's apex behind the source [m]
    bool beam = false;
};

// Half widths of the sampling boxes of round sources over their radius. Radiance's constants, as
// its values show them.
inline constexpr double kSphereBox = 0.7236;
inline constexpr double kCylinderBox = 0.8559;  ///< across the axis

/// One entry of the source list.
struct LightSource {
    SurfaceId object = kNoSurface;  ///< the emitting surface, or the redirecting surface surface of
                                    ///< a virtual source
    ModifierId material = kVoid;    ///< light, illum, glow or spotlight of the real source
    PrimitiveType material_type = PrimitiveType::light;
    PrimitiveType shape = PrimitiveType::sphere;  ///< of the real source
    Vec3 center;                                  ///< or unit direction of a distant source
    Vec3 u, v, w;                                 ///< half axes of the sampling box
    Vec3 normal;                                  ///< flat sources
    float radius = 0;                             ///< effective size
    float size = 0;                               ///< projected area [m²] or solid angle [sr]
    float proximity = 0;                          ///< glow: radius of influence [m]
    std::optional<SpotShape> spot;
    Rgb radiance;          ///< of the material without its patterns [W/(m² sr)]
    bool uniform = false;  ///< no modifier between surface and material, or below it: a constant
    bool plain = false;    ///< not a spotlight, no modifier between surface and material: its front
                           ///< sends the material's radiance times its patterns
    ModifierId patterns = kVoid;     ///< plain: the first of them
    bool side_by_side = false;       ///< plain: all patterns are functions of Program::has_lanes
    bool transparent_illum = false;  ///< illum that shows nothing of its own
    bool distant = false, flat = false, round = false, cylinder = false;
    bool is_virtual = false, follow = false;
    bool unusable = false;     ///< visible, but never sampled
    std::int32_t parent = -1;  ///< virtual: what it redirections
    int branch = 0;            ///< virtual: projection of the redirecting surface (prism2)
    std::optional<VirtualSourceBeam>
        beam;               ///< virtual: where its samples meet the redirecting surface
    float worth = 0;        ///< brightness of its radiance, about, times visible_share()
    float hit_rate = 0.5f;  ///< frozen share of shadow tests that get through
};

/// Share of the tests that see the source, where light samples are chosen by it: never 0.
[[nodiscard]] inline float visible_share(const LightSource& source) {
    return std::max(0.02f, source.hit_rate);
}

}  // namespace lightwalk
