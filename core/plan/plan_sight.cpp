#include "core/plan/plan_sight.h"

#include "core/scene/seen_material.h"

namespace lightwalk {
namespace {

constexpr int kMostCrossings = 128;  // of a line
constexpr int kMostUnseen = 8;       // surfaces above the first one that is seen

PlanLook look_of_modifier(const Scene& scene, ModifierId modifier) {
    const SeenMaterial seen = seen_material(scene, modifier);
    if (seen.traits.appearance == Appearance::absent) return PlanLook::absent;
    if (scene.modifier(*seen.material).type == PrimitiveType::antimatter) return PlanLook::absent;
    return seen.traits.transparent ? PlanLook::pane : PlanLook::solid;
}

}  // namespace

PlanSight::PlanSight(const Scene& scene, bool back_faces)
    : scene_(scene), back_faces_(back_faces), looks_(scene.modifier_count()) {
    for (std::size_t i = 0; i < looks_.size(); ++i)
        looks_[i] = look_of_modifier(scene, ModifierId{static_cast<std::int32_t>(i)});
}

PlanLook PlanSight::look_of(const Hit& hit) const {
    if (hit.modifier == kVoid || (hit.cos_out < 0 && !back_faces_)) return PlanLook::absent;
    return looks_[static_cast<std::size_t>(index(hit.modifier))];
}

void PlanSight::follow(const Vec3& from, const Vec3& along, double length, double apart,
                       FunctionRef<void(const PlanCrossing&)> take) const {
    double t = 0;
    for (int i = 0; i < kMostCrossings && t < length; ++i) {
        const Hit hit = scene_.geometry().intersect({from + t * along, along, length - t});
        if (!hit.exists()) return;
        t += hit.t;
        if (const PlanLook look = look_of(hit); look != PlanLook::absent)
            take({t, look, hit.cos_out > 0});
        t += apart;
    }
}

Hit PlanSight::first(const Vec3& from, const Vec3& along, double length) const {
    Hit hit;
    double passed = 0;
    for (int k = 0; k <= kMostUnseen; ++k) {
        hit = scene_.geometry().intersect({from + passed * along, along, length - passed});
        if (!hit.exists()) break;
        hit.t = passed += hit.t;
        if (look_of(hit) != PlanLook::absent) break;
    }
    return hit;
}

void PlanSight::look_down(std::span<const Vec3> places, std::span<Hit> hits) const {
    std::vector<RaySegment> rays;
    rays.reserve(places.size());
    for (const Vec3& place : places) rays.push_back({place, {0, 0, -1}, kHuge});
    scene_.geometry().intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        double depth = hits[i].t;
        for (int k = 0; k < kMostUnseen && hits[i].exists(); ++k) {
            if (look_of(hits[i]) != PlanLook::absent) break;
            rays[i].origin = hits[i].position;
            hits[i] = scene_.geometry().intersect(rays[i]);
            depth += hits[i].t;
        }
        hits[i].t = depth;
    }
}

}  // namespace lightwalk
