#include "core/cloud/scene_sights.h"

#include <algorithm>
#include <cmath>

#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

constexpr int kMostSurfaces = 16;   ///< that light is followed through
constexpr int kMostAlternates = 8;  ///< of alternates

/// One more surface on the way; never 0.
std::uint32_t met_surface(std::uint32_t met, std::int32_t surface, std::int32_t frame) {
    const std::uint64_t both = std::uint64_t{static_cast<std::uint32_t>(surface)} << 32 |
                               static_cast<std::uint32_t>(frame);
    const std::uint64_t bits = mix_bits(mix_bits(both + 1) ^ met);
    return static_cast<std::uint32_t>(bits >> 32) | 1;
}

/// Relative change of a mirror-like reflection, and of what it leaves, as the ray turns, by
/// Schlick's R = R0 + (1 - R0) (1 - cosθ)^5.
struct FresnelSlopes {
    double reflected = 0, left = 0;  ///< [1/rad]
};
FresnelSlopes fresnel_slopes(double cosine, double at_normal) {
    const double c = std::clamp(cosine, 0.0, 1.0), squared = (1 - c) * (1 - c);
    const double fourth = squared * squared;
    const double reflected = at_normal + (1 - at_normal) * fourth * (1 - c);
    const double slope = 5 * (1 - at_normal) * fourth * std::sqrt(1 - c * c);
    return {slope / std::max(reflected, kEpsilon), slope / std::max(1 - reflected, kEpsilon)};
}

FresnelSlopes slopes_of(const Hit& hit, const SurfaceLook& look) {
    return fresnel_slopes(std::abs(hit.cos_out), static_cast<double>(look.gloss));
}

}  // namespace

SceneSights::SceneSights(const Tracer& tracer)
    : tracer_(tracer), highlights_(tracer.lights(), tracer.options()) {
    const Scene& scene = tracer.scene();
    looks_.resize(scene.modifier_count());
    for (std::size_t i = 0; i < looks_.size(); ++i)
        looks_[i] = look_of(ModifierId{static_cast<std::int32_t>(i)});
    unsteady_ = scene.has_antimatter() || max_component(tracer.options().extinction) > 0;
}

SurfaceLook SceneSights::look_of(ModifierId modifier) const {
    const Scene& scene = tracer_.scene();
    std::optional<ModifierId> material = scene.material_of(modifier);
    MaterialTraits traits;
    for (int i = 0; i < kMostAlternates && material; ++i) {
        if (!scene.modifier(*material).node) return {};
        traits = scene.modifier(*material).node->traits();
        if (traits.appearance != Appearance::another) break;
        modifier = traits.seen;
        material = scene.material_of(modifier);
    }
    if (!material) return {Appearance::absent, 0, 0, 0, false, false};
    const ModifierRecord& record = scene.modifier(*material);
    SurfaceLook look;
    look.appearance = traits.appearance;
    look.gloss = static_cast<float>(traits.gloss);
    look.roughness = static_cast<float>(traits.roughness);
    look.diffuse = static_cast<float>(traits.diffuse);
    for (ModifierId m = modifier; m != kVoid; m = scene.modifier(m).next) {
        const PrimitiveKind kind = kind_of(scene.modifier(m).type);
        look.textured = look.textured || kind == PrimitiveKind::texture;
        look.patterned = look.patterned || kind == PrimitiveKind::pattern;
    }
    // Lamps are measured: their patterns are functions of the direction.
    if (is_light(record.type) && look.patterned && look.appearance == Appearance::constant)
        look.appearance = Appearance::unknown;
    return look;
}

SurfaceLook SceneSights::look_at(const Hit& hit) const {
    if (hit.modifier == kVoid) return {Appearance::absent, 0, 0, 0, false, false};
    SurfaceLook look = looks_[static_cast<std::size_t>(index(hit.modifier))];
    if (hit.cos_out >= 0 || look.appearance == Appearance::unknown) return look;
    if (!tracer_.options().back_faces_visible) return {Appearance::absent, 0, 0, 0, false, false};
    if (look.appearance == Appearance::mirror) look.appearance = Appearance::constant;  // black
    return look;
}

/// Go on from a hit, straight or mirrored.
Hit SceneSights::next(Walk& walk, const Hit& hit, bool reflect) const {
    walk.length += hit.t;
    walk.segment.origin = hit.position;
    walk.segment.t_max = walk.segment.t_max < kHuge ? walk.segment.t_max - hit.t : kHuge;
    if (reflect) {
        walk.segment.direction = normalize(walk.segment.direction + hit.normal * (2 * hit.cos_out));
        walk.segment.t_max = kHuge;
    }
    return tracer_.scene().geometry().intersect(walk.segment);
}

bool SceneSights::reflects_flat(const Hit& hit, const SurfaceLook& look) const {
    return !look.textured && tracer_.scene().surface(hit.surface).is_flat() &&
           hit.perturbation == Vec3{};
}

/// The source at infinity that the walk ends at, as a surface met.
std::uint32_t SceneSights::background(const Walk& walk) const {
    const Ray ray = tracer_.primary(walk.segment.origin, walk.segment.direction, 0, RandomStream{});
    const std::optional<SurfaceId> seen =
        walk.segment.t_max < kHuge ? std::nullopt : tracer_.lights().background(ray);
    return met_surface(walk.met, index(seen.value_or(kNoSurface)), 0);
}

float SceneSights::glossy_slope(const Walk& walk, const Hit& hit, const SurfaceLook& look) const {
    const GlossyLobe lobe{static_cast<double>(look.gloss), static_cast<double>(look.diffuse),
                          static_cast<double>(look.roughness)};
    return static_cast<float>(highlights_.slope(hit, walk.segment.direction, lobe));
}

/// The walk ends at `hit`, or at infinity.
void SceneSights::end(const RaySegment& ray, const Walk& walk, const Hit& hit,
                      const SurfaceLook& look, Sight& sight) const {
    sight.seen = true;
    const double length = hit.exists() ? walk.length + hit.t : kHuge;
    sight.position = ray.origin + ray.direction * length;
    sight.distance = static_cast<float>(length);
    sight.surface = walk.met;
    float slope = 0;
    if (!hit.exists()) {
        sight.surface = background(walk);
    } else if (look.appearance == Appearance::glossy) {
        if (walk.slopes) slope = glossy_slope(walk, hit, look);
    } else if (look.appearance == Appearance::polished) {
        slope = static_cast<float>(slopes_of(hit, look).left);
    } else if (look.appearance != Appearance::constant) {
        slope = kSharp;
    }
    sight.slope = unsteady_ ? kUnsteady : sight.slope + slope;
    if (sight.kind == PointKind::plain && sight.slope > 0) sight.kind = PointKind::glossy;
}

/// Walk on until the light's origin is found.
void SceneSights::follow(const RaySegment& ray, Walk walk, Hit hit, Sight& sight) const {
    for (int i = 0; i < kMostSurfaces; ++i) {
        if (!hit.exists()) return end(ray, walk, hit, {}, sight);
        const SurfaceLook look = look_at(hit);
        walk.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
        const bool mirror = look.appearance == Appearance::mirror && reflects_flat(hit, look);
        const bool pane = look.appearance == Appearance::pane && !look.textured;
        if (mirror) {
            hit = next(walk, hit, true);
        } else if (pane) {
            sight.slope += static_cast<float>(slopes_of(hit, look).left);
            if (sight.kind == PointKind::plain) sight.kind = PointKind::through;
            hit = next(walk, hit, false);
        } else if (look.appearance == Appearance::absent) {
            hit = next(walk, hit, false);
        } else {
            return end(ray, walk, hit, look, sight);
        }
    }
    end(ray, walk, hit, {}, sight);
}

void SceneSights::find(const RaySegment& ray, const Hit& first, bool slopes,
                       PixelSights& sights) const {
    sights.ray = true;
    sights.direction = ray.direction;
    sights.ahead = {};
    sights.mirrored = {};
    Walk walk{ray, slopes, 0, 0};
    Hit hit = first;
    for (int i = 0; i < kMostSurfaces && hit.exists(); ++i) {  // to the first surface that counts
        const SurfaceLook look = look_at(hit);
        if (look.appearance != Appearance::absent) break;
        walk.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
        hit = next(walk, hit, false);
    }
    if (!hit.exists()) return follow(ray, walk, hit, sights.ahead);
    const SurfaceLook look = look_at(hit);
    const bool reflects = look.appearance == Appearance::mirror ||
                          look.appearance == Appearance::pane ||
                          look.appearance == Appearance::polished;
    if (reflects) {
        sights.mirrored.kind = PointKind::mirrored;
        sights.mirrored.slope = static_cast<float>(slopes_of(hit, look).reflected);
        if (reflects_flat(hit, look)) {
            Walk mirrored = walk;
            mirrored.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
            const Hit image = next(mirrored, hit, true);
            follow(ray, mirrored, image, sights.mirrored);
        } else {
            Walk mirrored = walk;
            mirrored.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
            end(ray, mirrored, hit, {Appearance::constant, 0, 0, 0, false, false}, sights.mirrored);
            sights.mirrored.slope = kSharp;
        }
        if (look.appearance == Appearance::mirror) return;
    }
    follow(ray, walk, hit, sights.ahead);
}

}  // namespace lightwalk
