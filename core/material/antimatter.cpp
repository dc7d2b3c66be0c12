// antimatter: the boundary of a volume in which surfaces of certain modifiers do not exist.
// Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxModifiers = 511;

class Antimatter final : public Modifier {
  public:
    explicit Antimatter(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;

  private:
    [[nodiscard]] const ClipSet* clipped_behind(const Ray& ray, TraceContext& context) const;
    [[nodiscard]] bool cuts_solid(const Ray& ray) const;

    ModifierId face_ = kVoid;  ///< what the cut shows
    ClipSet clipped_;
};

Antimatter::Antimatter(const ModifierBuild& build) {
    const Primitive& primitive = build.primitive;
    require_least_strings(primitive, 1);
    require_most_strings(primitive, kMaxModifiers);
    const auto warn = [&](const char* problem, const std::string& name) {
        build.warnings.warn(to_prefix(primitive.where) + "antimatter \"" + primitive.name +
                            "\": " + problem + " modifier \"" + name + "\"");
    };
    std::vector<ModifierId>& ids = clipped_.modifiers;
    for (std::size_t i = 0; i < primitive.strings.size(); ++i) {
        if (build.undefined(i)) {
            warn("undefined", primitive.strings[i]);
            continue;
        }
        const ModifierId id = build.reference(i);
        if (id == kVoid) continue;
        if (i == 0) face_ = id;
        const auto at = std::lower_bound(ids.begin(), ids.end(), id);
        if (at != ids.end() && *at == id)
            warn("duplicate", primitive.strings[i]);
        else
            ids.insert(at, id);
    }
}

bool Antimatter::shade(Ray& ray, TraceContext& context) const {
    ray.next_clip = clipped_behind(ray, context);
    if (face_ != kVoid && cuts_solid(ray)) {
        flip_surface(ray);
        context.tracer.shade_or_pass(ray, face_, context);
    } else {
        context.tracer.pass_through(ray, context);
    }
    return true;
}

/// What is cut away behind this boundary: more when the ray enters the volume, less when it leaves.
const ClipSet* Antimatter::clipped_behind(const Ray& ray, TraceContext& context) const {
    const bool entering = ray.hit.cos_out > 0;
    if (!ray.clip && !entering) return nullptr;
    if (!ray.clip) return clipped_.modifiers.empty() ? nullptr : &clipped_;
    const std::vector<ModifierId>& before = ray.clip->modifiers;
    ClipSet set;
    const auto out = std::back_inserter(set.modifiers);
    if (entering) {
        std::set_union(before.begin(), before.end(), clipped_.modifiers.begin(),
                       clipped_.modifiers.end(), out);
    } else {
        std::set_difference(before.begin(), before.end(), clipped_.modifiers.begin(),
                            clipped_.modifiers.end(), out);
    }
    if (set.modifiers.empty()) return nullptr;
    if (set.modifiers.size() == before.size()) return ray.clip;
    context.path.clip_sets.push_back(std::move(set));
    return &context.path.clip_sets.back();
}

/// Whether the path is inside clipped matter here: it has entered more of it than it has left.
bool Antimatter::cuts_solid(const Ray& ray) const {
    int depth = 0;
    for (const Ray* r = &ray; r->parent; r = r->parent) {
        if ((r->kind & kSameSide) || !clipped_.contains(r->parent->hit.modifier)) continue;
        depth += r->parent->hit.cos_out > 0 ? 1 : -1;
    }
    return depth > 0;
}

}  // namespace

std::unique_ptr<const Modifier> make_antimatter(const ModifierBuild& build) {
    return std::make_unique<Antimatter>(build);
}

}  // namespace lightwalk
