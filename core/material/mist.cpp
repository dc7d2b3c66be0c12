// mist: the boundary of a volume that absorbs and scatters light.
// Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include <algorithm>

#include "core/light/light_sources.h"
#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxSources = 32;

class Mist final : public Modifier {
  public:
    explicit Mist(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.transparent = true}; }

  private:
    void enter(Medium& medium, const Rgb& pattern, const ScatterList* mine,
               TraceContext& context) const;
    void leave(Medium& medium, const Rgb& pattern, const ScatterList* mine,
               TraceContext& context) const;

    ModifierId self_, next_;
    std::string name_;
    bool has_albedo_, has_eccentricity_;
    Rgb extinction_;  ///< added by this mist [1/m]
    Rgb albedo_;
    float eccentricity_ = 0;
};

const ScatterList* keep(ScatterList list, TraceContext& context) {
    context.path.scatter_lists.push_back(std::move(list));
    return &context.path.scatter_lists.back();
}

/// Whether one list holds all sources of another; null lists are empty.
bool holds(const ScatterList* list, const ScatterList* other) {
    if (!other || list == other) return true;
    return list && std::all_of(other->sources.begin(), other->sources.end(),
                               [list](std::int32_t source) { return list->contains(source); });
}

Mist::Mist(const ModifierBuild& build)
    : self_(build.self), next_(build.next), name_(build.primitive.name) {
    const Primitive& primitive = build.primitive;
    require_most_strings(primitive, kMaxSources);
    if (primitive.reals.size() > 7) require_exact_reals(primitive, 7);
    const std::vector<std::string>& identifiers = primitive.strings;
    for (auto at = identifiers.begin(); at != identifiers.end(); ++at) {
        if (std::find(identifiers.begin(), at, *at) != at) {
            build.warnings.warn(to_prefix(primitive.where) + "mist \"" + name_ +
                                "\": duplicate source \"" + *at + "\"");
        }
    }
    has_albedo_ = primitive.reals.size() >= 6;
    has_eccentricity_ = primitive.reals.size() >= 7;
    if (primitive.reals.size() >= 3) extinction_ = color_argument(primitive);
    if (has_albedo_) albedo_ = color_argument(primitive, 3);
    if (has_eccentricity_) eccentricity_ = static_cast<float>(primitive.reals[6]);
}

bool Mist::shade(Ray& ray, TraceContext& context) const {
    context.tracer.apply_textures(ray, next_, context);
    Ray child;
    if (!context.tracer.spawn(child, kTransferred, ray, nullptr)) return true;
    child.direction = ray.direction;
    const ScatterList* mine = context.tracer.lights().scattered_by(self_);
    if (ray.hit.cos_out > 0) {
        enter(child.medium, ray.pattern, mine, context);
    } else {
        const bool began_inside = !holds(ray.medium.scatter, mine);
        if (began_inside) enter(ray.medium, ray.pattern, mine, context);
        child.medium = ray.medium;
        leave(child.medium, ray.pattern, mine, context);
    }
    context.tracer.trace(child, context);
    ray.value = child.value;
    ray.mirrored = child.mirrored;
    ray.reflected_path_length = ray.hit.t + child.reflected_path_length;
    ray.unreflected_path_length = ray.hit.t + child.unreflected_path_length;
    return true;
}

void Mist::enter(Medium& medium, const Rgb& pattern, const ScatterList* mine,
                 TraceContext& context) const {
    medium.extinction += extinction_ * pattern;
    if (has_albedo_) medium.albedo = albedo_;
    if (has_eccentricity_) medium.eccentricity = eccentricity_;
    if (holds(medium.scatter, mine)) return;
    if (!medium.scatter) {
        medium.scatter = mine;
        return;
    }
    ScatterList list = *medium.scatter;
    for (const std::int32_t source : mine->sources) {
        if (list.contains(source)) continue;
        if (list.sources.size() == kMaxSources) {
            context.warnings.warn("mist \"" + name_ +
                                  "\": too many scattering sources in overlapping mists");
            break;
        }
        list.sources.push_back(source);
    }
    medium.scatter = keep(std::move(list), context);
}

void Mist::leave(Medium& medium, const Rgb& pattern, const ScatterList* mine,
                 TraceContext& context) const {
    const RenderOptions& options = context.tracer.options();
    medium.extinction -= extinction_ * pattern;
    for (std::size_t i = 0; i < 3; ++i) {
        medium.extinction[i] = std::max(medium.extinction[i], options.extinction[i]);
    }
    if (has_albedo_) medium.albedo = options.albedo;
    if (has_eccentricity_) medium.eccentricity = static_cast<float>(options.eccentricity);
    if (!medium.scatter || !mine) return;
    if (medium.scatter == mine) {
        medium.scatter = nullptr;
        return;
    }
    ScatterList list;
    for (const std::int32_t source : medium.scatter->sources) {
        if (!mine->contains(source)) list.sources.push_back(source);
    }
    if (list.sources.size() == medium.scatter->sources.size()) return;
    medium.scatter = list.sources.empty() ? nullptr : keep(std::move(list), context);
}

}  // namespace

std::unique_ptr<const Modifier> make_mist(const ModifierBuild& build) {
    return std::make_unique<Mist>(build);
}

}  // namespace lightwalk
