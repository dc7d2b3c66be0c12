#include "core/cloud/visibility_probe.h"

#include <algorithm>
#include <cmath>

#include "core/cloud/material_bits.h"
#include "core/light/light_sources.h"
#include "core/scene/seen_material.h"

namespace lightwalk {
namespace {

constexpr int kMostSurfaces = 16;  ///< surfaces that a ray is followed through

/// Perturbations of a normal up to which a surface is even but for ripples: they bend light by some
/// pixels, where the image of another one would be far from it as soon as the eye moves [rad].
constexpr double kRipple = 0.01;

/// Extends the hash of a path by one surface; never 0. Its kMaterialBits are those of the surfaces'
/// modifiers alone.
std::uint32_t met_surface(std::uint32_t met, std::uint32_t surface, std::int32_t frame,
                          ModifierId modifier) {
    const std::uint64_t both = std::uint64_t{surface} << 32 | static_cast<std::uint32_t>(frame);
    const auto bits = static_cast<std::uint32_t>(mix_bits(mix_bits(both + 1) ^ met) >> 32);
    constexpr std::uint32_t kNeverNone = kMaterialBits + 1;
    return (bits & ~kMaterialBits) | kNeverNone | met_material(met, modifier);
}

/// Relative changes of a mirror-like reflection and of the transmitted rest as the ray turns, by
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

FresnelSlopes slopes_of(const Hit& hit, const SurfaceAppearance& appearance) {
    return fresnel_slopes(std::abs(hit.cos_out), static_cast<double>(appearance.gloss));
}

}  // namespace

VisibilityProbe::VisibilityProbe(const Tracer& tracer)
    : tracer_(tracer),
      highlights_(tracer.lights(), tracer.scene().geometry(), tracer.options()),
      data_cells_(tracer.scene()) {
    const Scene& scene = tracer.scene();
    appearances_.resize(scene.modifier_count());
    for (std::size_t i = 0; i < appearances_.size(); ++i)
        appearances_[i] = appearance_of(ModifierId{static_cast<std::int32_t>(i)});
    never_reuse_ = scene.has_antimatter() || max_component(tracer.options().extinction) > 0;
}

SurfaceAppearance VisibilityProbe::appearance_of(ModifierId modifier) const {
    const Scene& scene = tracer_.scene();
    const SeenMaterial seen = seen_material(scene, modifier);
    const MaterialTraits& traits = seen.traits;
    if (!seen.material) return {Appearance::absent, 0, 0, 0, false, false};
    const ModifierRecord& record = scene.modifier(*seen.material);
    SurfaceAppearance appearance;
    appearance.appearance = traits.appearance;
    appearance.gloss = static_cast<float>(traits.gloss);
    appearance.roughness = static_cast<float>(traits.roughness);
    appearance.diffuse = static_cast<float>(traits.diffuse);
    for (ModifierId m = seen.first; m != kVoid; m = scene.modifier(m).next) {
        const PrimitiveKind kind = kind_of(scene.modifier(m).type);
        appearance.textured = appearance.textured || kind == PrimitiveKind::texture;
        appearance.patterned = appearance.patterned || is_pattern(kind);
    }
    // Patterns on lights are usually measured distributions, which depend on the direction.
    if (is_light(record.type) && appearance.patterned &&
        appearance.appearance == Appearance::constant)
        appearance.appearance = Appearance::unknown;
    return appearance;
}

SurfaceAppearance VisibilityProbe::appearance_at(const Hit& hit) const {
    if (hit.modifier == kVoid) return {Appearance::absent, 0, 0, 0, false, false};
    SurfaceAppearance appearance = appearances_[static_cast<std::size_t>(index(hit.modifier))];
    if (hit.cos_out >= 0 || appearance.appearance == Appearance::unknown) return appearance;
    if (!tracer_.options().back_faces_visible) return {Appearance::absent, 0, 0, 0, false, false};
    if (appearance.appearance == Appearance::mirror)
        appearance.appearance = Appearance::constant;  // black
    return appearance;
}

void VisibilityProbe::Walk::pass(const Hit& hit, bool reflect) {
    length += hit.t;
    segment.origin = hit.position;
    segment.t_max = segment.t_max < kHuge ? segment.t_max - hit.t : kHuge;
    if (!reflect) return;
    segment.direction = normalize(segment.direction + hit.normal * (2 * hit.cos_out));
    segment.t_max = kHuge;
}

bool VisibilityProbe::reflects_flat(const Walk& walk, const Hit& hit,
                                    const SurfaceAppearance& appearance) const {
    return (!appearance.textured || walk.needs.steered) &&
           tracer_.scene().surface(hit.surface).is_flat() && hit.perturbation == Vec3{};
}

/// The hash of a path that goes on to a hit.
std::uint32_t VisibilityProbe::met(const Walk& walk, const Hit& hit) const {
    return met_surface(walk.met, tracer_.scene().surface_key(hit.surface), index(hit.instance),
                       hit.modifier);
}

/// The hash of a path that ends at a source at infinity, or at nothing.
std::uint32_t VisibilityProbe::background(const Walk& walk) const {
    const Ray ray = tracer_.primary(walk.segment.origin, walk.segment.direction, 0, RandomStream{});
    const std::optional<SurfaceId> seen =
        walk.segment.t_max < kHuge ? std::nullopt : tracer_.lights().background(ray);
    return met_surface(walk.met, tracer_.scene().surface_key(seen.value_or(kNoSurface)), 0, kVoid);
}

float VisibilityProbe::glossy_slope(const Walk& walk, const Hit& hit,
                                    const SurfaceAppearance& appearance) const {
    const GlossyLobe lobe{static_cast<double>(appearance.gloss),
                          static_cast<double>(appearance.diffuse),
                          static_cast<double>(appearance.roughness)};
    return static_cast<float>(highlights_.slope(hit, walk.segment.direction, lobe));
}

/// The ray of a walk at a hit, with what those modifiers of the surface's chain do to it that are
/// of a kind that `applies`.
Ray VisibilityProbe::modified_ray(const Walk& walk, const Hit& hit,
                                  bool (*applies)(PrimitiveKind)) const {
    const Scene& scene = tracer_.scene();
    Ray ray = tracer_.primary(walk.segment.origin, walk.segment.direction, 0, RandomStream{});
    ray.hit = hit;
    for (ModifierId m = hit.modifier; m != kVoid; m = scene.modifier(m).next) {
        const ModifierRecord& record = scene.modifier(m);
        if (record.node && applies(kind_of(record.type)))
            (void)record.node->shade(ray, *walk.needs.patterns);
    }
    return ray;
}

/// The brightness of the patterns of a surface's chain. Textures are left out: what patterns make
/// of a perturbed normal is too fine to be seen in passing.
float VisibilityProbe::pattern_at(const Walk& walk, const Hit& hit) const {
    const float value = brightness(modified_ray(walk, hit, is_pattern).pattern);
    return std::isfinite(value) ? value : 1;
}

/// What the texture of an image that is taken for an even one's adds to its slope.
float VisibilityProbe::ripple_slope(const Walk& walk, const Hit& hit,
                                    const SurfaceAppearance& appearance) const {
    if (!appearance.textured || !walk.needs.slopes || walk.needs.patterns == nullptr) return 0;
    const Ray ray =
        modified_ray(walk, hit, [](PrimitiveKind kind) { return kind == PrimitiveKind::texture; });
    return length_squared(ray.hit.perturbation) <= kRipple * kRipple ? 0 : kMirrorLike;
}

/// Ends a walk at `hit`, or at infinity: sets its result.
void VisibilityProbe::end(const Walk& walk, const Hit& hit,
                          const SurfaceAppearance& appearance) const {
    PrimaryVisibility& primary = *walk.primary;
    primary.seen = true;
    const double length = hit.exists() ? walk.length + hit.t : kHuge;
    primary.position = walk.pixel->origin + walk.pixel->direction * length;
    primary.distance = static_cast<float>(length);
    primary.surface = walk.met;
    float slope = 0;
    if (!hit.exists()) {
        primary.surface = background(walk);
    } else if (appearance.appearance == Appearance::glossy) {
        if (walk.needs.slopes) slope = glossy_slope(walk, hit, appearance);
    } else if (appearance.appearance == Appearance::polished) {
        slope = static_cast<float>(slopes_of(hit, appearance).left);
    } else if (appearance.appearance != Appearance::constant) {
        slope = kMirrorLike;
    }
    if (walk.needs.patterns != nullptr && appearance.patterned && hit.exists())
        primary.pattern = pattern_at(walk, hit);
    primary.slope = never_reuse_ ? kNeverReuse : primary.slope + slope;
    if (primary.kind == PointKind::plain && primary.slope > 0) primary.kind = PointKind::glossy;
}

/// Processes the next hit of a walk. True: it continues behind that surface; false: it has ended
/// there.
bool VisibilityProbe::goes_on(Walk& walk, const Hit& hit) const {
    if (!hit.exists() || walk.surfaces++ == kMostSurfaces) {
        end(walk, hit, {});
        return false;
    }
    const SurfaceAppearance appearance = appearance_at(hit);
    walk.met = met(walk, hit);
    const bool mirror =
        appearance.appearance == Appearance::mirror && reflects_flat(walk, hit, appearance);
    const bool pane =
        appearance.appearance == Appearance::pane && (!appearance.textured || walk.needs.steered);
    if (!mirror && !pane && appearance.appearance != Appearance::absent) {
        end(walk, hit, appearance);
        return false;
    }
    if (mirror || pane) walk.primary->slope += ripple_slope(walk, hit, appearance);
    if (pane) {
        walk.primary->slope += static_cast<float>(slopes_of(hit, appearance).left);
        if (walk.primary->kind == PointKind::plain) walk.primary->kind = PointKind::through;
        if (const std::uint32_t cell = data_cells_.find(hit, walk.segment.direction); cell != 0)
            walk.met = met_surface(walk.met, cell, 0, kVoid);
    }
    walk.pass(hit, mirror);
    return true;
}

/// Processes the next hit of a walk up to the first surface with a material, whose reflection
/// begins another walk. True: it continues.
bool VisibilityProbe::begins(Walk& walk, const Hit& hit, std::vector<Walk>& images) const {
    if (!hit.exists()) return goes_on(walk, hit);
    const SurfaceAppearance appearance = appearance_at(hit);
    if (appearance.appearance == Appearance::absent && walk.surfaces < kMostSurfaces) {
        ++walk.surfaces;
        walk.met = met(walk, hit);
        walk.pass(hit, false);
        return true;
    }
    PrimaryVisibility* const image = walk.image;
    walk.image = nullptr;
    walk.surfaces = 0;
    const bool mirror = appearance.appearance == Appearance::mirror;
    if (mirror || appearance.appearance == Appearance::pane ||
        appearance.appearance == Appearance::polished) {
        image->kind = PointKind::mirrored;
        image->slope = static_cast<float>(slopes_of(hit, appearance).reflected);
        Walk mirrored = walk;
        mirrored.primary = image;
        mirrored.met = met(walk, hit);
        if (reflects_flat(walk, hit, appearance)) {
            image->slope += ripple_slope(walk, hit, appearance);
            mirrored.pass(hit, true);
            images.push_back(mirrored);
        } else {
            end(mirrored, hit, {Appearance::constant, 0, 0, 0, false, false});
            image->slope = kMirrorLike;
        }
    }
    return !mirror && goes_on(walk, hit);
}

/// Follows all walks to their ends. Their rays are cast together, as those of neighbouring pixels
/// are coherent.
void VisibilityProbe::follow(std::vector<Walk>& walks, Scratch& scratch) const {
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

void VisibilityProbe::find(std::span<const RaySegment> rays, std::span<const Hit> first,
                           const Needs& needs, std::span<PixelVisibility> visibility,
                           Scratch& scratch) const {
    scratch.ahead.clear();
    scratch.images.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!visibility[i].ray) continue;
        visibility[i].direction = rays[i].direction;
        visibility[i].ahead = visibility[i].mirrored = {};
        Walk walk{&rays[i], &visibility[i].ahead, &visibility[i].mirrored, rays[i], needs};
        if (begins(walk, first[i], scratch.images)) scratch.ahead.push_back(walk);
    }
    follow(scratch.ahead, scratch);
    follow(scratch.images, scratch);
}

}  // namespace lightwalk
