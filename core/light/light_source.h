#pragma once
// One light source, real or virtual, as the direct calculation samples it.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/light/source_box.h"
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

/// What a source sends out.
struct SourceEmission {
    ModifierId material = kVoid;  ///< light, illum, glow or spotlight of the real source
    PrimitiveType material_type = PrimitiveType::light;
    Rgb radiance;                   ///< Le without the material's patterns [W/(m² sr)]
    ModifierId patterns = kVoid;    ///< the first of the material's patterns
    float proximity = 0;            ///< radius of influence of a glow [m]
    std::optional<SpotShape> spot;  ///< no light goes elsewhere
    bool uniform = false;  ///< no modifier between surface and material, or below it: a constant
    bool plain = false;    ///< not a spotlight, no modifier between surface and material: its front
                           ///< sends the material's radiance times its patterns
    bool has_lanes = false;          ///< plain, and Program::has_lanes holds for all patterns
    bool transparent_illum = false;  ///< illum that shows nothing of its own
};

/// Where the light of a virtual source comes from: a mirror or prism redirects that of another one.
struct SourceRedirection {
    std::int32_t parent = -1;  ///< the source that is redirected; -1: this source is real
    int branch = 0;            ///< which of the images that a prism2 makes
    bool follow = false;  ///< shadow rays have to be traced to the parent by way of the surface
    std::optional<VirtualSourceBeam> beam;  ///< where samples meet the redirecting surface

    [[nodiscard]] bool is_virtual() const { return parent >= 0; }
};

/// One entry of the source list.
struct LightSource : SourceBox, SourceEmission, SourceRedirection {
    /// The emitting surface; of a virtual source, the one that redirects.
    SurfaceId object = kNoSurface;
    bool unusable = false;  ///< visible, but never sampled
    float worth = 0;        ///< brightness of its radiance, about, times visible_share()
    float hit_rate = 0.5f;  ///< frozen share of shadow tests that get through
};

/// Share of the tests that see the source, where light samples are chosen by it: never 0.
[[nodiscard]] inline float visible_share(const LightSource& source) {
    return std::max(0.02f, source.hit_rate);
}

}  // namespace lightwalk
