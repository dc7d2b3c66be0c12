// mist: the boundary of a volume that absorbs and scatters light.
// Source: Radiance's manual "The Radiance 6.x Scene Description Language".
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
    using Indices = std::vector<std::int32_t>;
    [[nodiscard]] Indices sources(TraceContext& context) const;
    void enter(Medium& medium, const Rgb& pattern, const Indices& mine,
               TraceContext& context) const;
    void leave(Medium& medium, const Rgb& pattern, const Indices& mine,
               TraceContext& context) const;

    ModifierId next_;
    std::string name_;
    std::vector<std::string> identifiers_;
    bool has_albedo_, has_eccentricity_;
    Rgb extinction_;  ///< added by this mist [1/m]
    Rgb albedo_;
    float eccentricity_ = 0;
};

bool contains(const std::vector<std::int32_t>& list, std::int32_t source) {
    return std::find(list.begin(), list.end(), source) != list.end();
}

Mist::Mist(const ModifierBuild& build) : next_(build.next), name_(build.primitive.name) {
    const Primitive& primitive = build.primitive;
    require_most_strings(primitive, kMaxSources);
    if (primitive.reals.size() > 7) require_exact_reals(primitive, 7);
    for (const std::string& identifier : primitive.strings) {
        if (std::find(identifiers_.begin(), identifiers_.end(), identifier) == identifiers_.end()) {
            identifiers_.push_back(identifier);
        } else {
            build.warnings.warn(to_prefix(primitive.where) + "mist \"" + name_ +
                                "\": duplicate source \"" + identifier + "\"");
        }
    }
    has_albedo_ = primitive.reals.size() >= 6;
    has_eccentricity_ = primitive.reals.size() >= 7;
    if (primitive.reals.size() >= 3) extinction_ = color_argument(primitive);
    if (has_albedo_) albedo_ = color_argument(primitive, 3);
    if (has_eccentricity_) eccentricity_ = static_cast<float>(primitive.reals[6]);
}

/// The mist's entries of the source list.
Mist::Indices Mist::sources(TraceContext& context) const {
    Indices mine;
    for (const std::string& identifier : identifiers_) {
        const std::optional<std::int32_t> source = context.tracer.lights().find(identifier);
        if (!source) {
            context.warnings.warn("mist \"" + name_ + "\": unknown source \"" + identifier + "\"");
        } else if (!contains(mine, *source)) {
            mine.push_back(*source);
        }
    }
    return mine;
}

bool Mist::shade(Ray& ray, TraceContext& context) const {
    context.tracer.apply_textures(ray, next_, context);
    Ray child;
    if (!context.tracer.spawn(child, kTransferred, ray, nullptr)) return true;
    child.direction = ray.direction;
    const Indices mine = sources(context);
    if (ray.hit.rod > 0) {
        enter(child.medium, ray.pattern, mine, context);
    } else {
        const ScatterList* listed = ray.medium.scatter;
        const bool began_inside = !std::all_of(
            mine.begin(), mine.end(),
            [listed](std::int32_t source) { return listed && contains(listed->sources, source); });
        if (began_inside) enter(ray.medium, ray.pattern, mine, context);
        child.medium = ray.medium;
        leave(child.medium, ray.pattern, mine, context);
    }
    context.tracer.trace(child, context);
    ray.value = child.value;
    ray.mirrored = child.mirrored;
    ray.mirrored_distance = ray.hit.t + child.mirrored_distance;
    ray.unmirrored_distance = ray.hit.t + child.unmirrored_distance;
    return true;
}

void Mist::enter(Medium& medium, const Rgb& pattern, const Indices& mine,
                 TraceContext& context) const {
    medium.extinction += extinction_ * pattern;
    if (has_albedo_) medium.albedo = albedo_;
    if (has_eccentricity_) medium.eccentricity = eccentricity_;
    ScatterList list;
    if (medium.scatter) list = *medium.scatter;
    const std::size_t before = list.sources.size();
    for (const std::int32_t source : mine) {
        if (contains(list.sources, source)) continue;
        if (list.sources.size() == kMaxSources) {
            context.warnings.warn("mist \"" + name_ +
                                  "\": too many scattering sources in overlapping mists");
            break;
        }
        list.sources.push_back(source);
    }
    if (list.sources.size() == before) return;
    context.scatter_lists.push_back(std::move(list));
    medium.scatter = &context.scatter_lists.back();
}

void Mist::leave(Medium& medium, const Rgb& pattern, const Indices& mine,
                 TraceContext& context) const {
    const RenderOptions& options = context.tracer.options();
    medium.extinction -= extinction_ * pattern;
    for (std::size_t i = 0; i < 3; ++i) {
        medium.extinction[i] = std::max(medium.extinction[i], options.extinction[i]);
    }
    if (has_albedo_) medium.albedo = options.albedo;
    if (has_eccentricity_) medium.eccentricity = static_cast<float>(options.eccentricity);
    if (!medium.scatter) return;
    ScatterList list;
    for (const std::int32_t source : medium.scatter->sources) {
        if (!contains(mine, source)) list.sources.push_back(source);
    }
    if (list.sources.size() == medium.scatter->sources.size()) return;
    medium.scatter = nullptr;
    if (list.sources.empty()) return;
    context.scatter_lists.push_back(std::move(list));
    medium.scatter = &context.scatter_lists.back();
}

}  // namespace

std::unique_ptr<const Modifier> make_mist(const ModifierBuild& build) {
    return std::make_unique<Mist>(build);
}

}  // namespace lightwalk
