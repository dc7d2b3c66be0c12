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
    : tracer_(tracer), highlights_(tracer.lights(), tracer.scene().geometry(), tracer.options()) {
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

void SceneSights::Walk::pass(const Hit& hit, bool reflect) {
    length += hit.t;
    segment.origin = hit.position;
    segment.t_max = segment.t_max < kHuge ? segment.t_max - hit.t : kHuge;
    if (!reflect) return;
    segment.direction = normalize(segment.direction + hit.normal * (2 * hit.cos_out));
    segment.t_max = kHuge;
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
void SceneSights::end(const Walk& walk, const Hit& hit, const SurfaceLook& look) const {
    Sight& sight = *walk.sight;
    sight.seen = true;
    const double length = hit.exists() ? walk.length + hit.t : kHuge;
    sight.position = walk.pixel->origin + walk.pixel->direction * length;
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

/// The next surface on the way. False: the light comes from there; true: from farther on.
bool SceneSights::goes_on(Walk& walk, const Hit& hit) const {
    if (!hit.exists() || walk.surfaces++ == kMostSurfaces) {
        end(walk, hit, {});
        return false;
    }
    const SurfaceLook look = look_at(hit);
    walk.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
    const bool mirror = look.appearance == Appearance::mirror && reflects_flat(hit, look);
    const bool pane = look.appearance == Appearance::pane && !look.textured;
    if (!mirror && !pane && look.appearance != Appearance::absent) {
        end(walk, hit, look);
        return false;
    }
    if (pane) {
        walk.sight->slope += static_cast<float>(slopes_of(hit, look).left);
        if (walk.sight->kind == PointKind::plain) walk.sight->kind = PointKind::through;
    }
    walk.pass(hit, mirror);
    return true;
}

/// The same up to the first surface that counts, which may mirror something: another walk.
bool SceneSights::begins(Walk& walk, const Hit& hit, std::vector<Walk>& images) const {
    if (!hit.exists()) return goes_on(walk, hit);
    const SurfaceLook look = look_at(hit);
    if (look.appearance == Appearance::absent && walk.surfaces < kMostSurfaces) {
        ++walk.surfaces;
        walk.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
        walk.pass(hit, false);
        return true;
    }
    Sight* const image = walk.image;
    walk.image = nullptr;
    walk.surfaces = 0;
    const bool mirror = look.appearance == Appearance::mirror;
    if (mirror || look.appearance == Appearance::pane || look.appearance == Appearance::polished) {
        image->kind = PointKind::mirrored;
        image->slope = static_cast<float>(slopes_of(hit, look).reflected);
        Walk mirrored = walk;
        mirrored.sight = image;
        mirrored.met = met_surface(walk.met, index(hit.surface), index(hit.frame));
        if (reflects_flat(hit, look)) {
            mirrored.pass(hit, true);
            images.push_back(mirrored);
        } else {
            end(mirrored, hit, {Appearance::constant, 0, 0, 0, false, false});
            image->slope = kSharp;
        }
    }
    return !mirror && goes_on(walk, hit);
}

/// To the ends of all walks, whose rays are cast together: neighbours go similar ways.
void SceneSights::follow(std::vector<Walk>& walks, Scratch& scratch) const {
    while (!walks.empty()) {
        scratch.segments.clear();
        for (const Walk& walk : walks) scratch.segments.push_back(walk.segment);
        scratch.hits.resize(walks.size());
        tracer_.scene().geometry().intersect(scratch.segments, scratch.hits);
        std::size_t left = 0;
        for (std::size_t i = 0; i < walks.size(); ++i) {
            Walk& walk = walks[i];
            const Hit& hit = scratch.hits[i];
            if (walk.image ? begins(walk, hit, scratch.images) : goes_on(walk, hit))
                walks[left++] = walk;
        }
        walks.resize(left);
    }
}

void SceneSights::find(std::span<const RaySegment> rays, std::span<const Hit> first, bool slopes,
                       std::span<PixelSights> sights, Scratch& scratch) const {
    scratch.ahead.clear();
    scratch.images.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!sights[i].ray) continue;
        sights[i].direction = rays[i].direction;
        sights[i].ahead = sights[i].mirrored = {};
        Walk walk{&rays[i], &sights[i].ahead, &sights[i].mirrored, rays[i], slopes};
        if (begins(walk, first[i], scratch.images)) scratch.ahead.push_back(walk);
    }
    follow(scratch.ahead, scratch);
    follow(scratch.images, scratch);
}

}  // namespace lightwalk
