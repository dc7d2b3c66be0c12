#include "core/geometry/placed_scene.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

/// By so much distances may differ that are calculated in two ways [m].
constexpr double kSameCrossing = 1e-3 * kEpsilon;

void begin_tracing(TracedRay& ray, const RaySegment& segment) {
    ray.origin = segment.origin;
    ray.direction = segment.direction;
    ray.limit = std::min(segment.t_max, kHuge);
    ray.local_instance = kWorld;
}

/// Takes a copy: no reference then keeps the caller's candidate out of registers.
void collect(NearestRay& ray, Candidate candidate) {
    try {
        ray.all->push_back(candidate);
    } catch (const std::bad_alloc&) {  // must not unwind through the C frames of the search
        ray.out_of_memory = true;
    }
}

GeometryInput with_a_model(GeometryInput input) {
    if (input.models.empty()) input.models.emplace_back();
    return input;
}

LocalRay local_ray(const Vec3& origin, const Vec3& direction, const Matrix& to_local, double size) {
    return {to_local.point(origin), to_local.vector(direction) * size, size};
}

}  // namespace

PlacedScene::PlacedScene(GeometryInput input, const TaskRunner& task_runner)
    : input_(with_a_model(std::move(input))), paths_(input_) {
    models_.reserve(input_.models.size());
    for (const ModelGeometry& model : input_.models)
        models_.emplace_back(*input_.surfaces, model, task_runner);
    for (const std::uint32_t model : paths_.order())
        coincidence_ = std::max(coincidence_, kEpsilon * paths_.use(model).most_size);
    std::vector<std::optional<Bounds>> cubes(input_.models.size());
    bounds_ = model_bounds(0, cubes);
}

Bounds PlacedScene::model_bounds(std::uint32_t model,
                                 std::vector<std::optional<Bounds>>& cubes) const {
    Bounds bounds = models_[model].bounds();
    for (const Placement& placement : input_.models[model].placements) {
        if (!cubes[placement.model]) {
            const std::optional<Bounds>& stated = input_.models[placement.model].cube;
            cubes[placement.model] =
                stated ? *stated : cube_around(model_bounds(placement.model, cubes));
        }
        extend(bounds, transformed(*cubes[placement.model], placement.transform.forward));
    }
    return bounds;
}

std::size_t PlacedScene::memory_bytes() const {
    std::size_t bytes = 0;
    for (const ModelPrimitives& model : models_) bytes += sizeof(model) + model.memory_bytes();
    return bytes;
}

void PlacedScene::enter(TracedRay& ray, InstanceId instance, const InnerSpace& space) {
    ray.local = local_ray(ray.origin, ray.direction, space.to_local, space.size);
    ray.local_model = space.model;
    ray.local_override = space.override_surface;
    ray.local_instance = instance;
}

std::optional<Candidate> PlacedScene::cross(TracedRay& ray, PrimitiveRef what) const {
    if (what.instance == kWorld) {
        const auto hit = models_[0].intersect(what.primitive, ray.origin, ray.direction, ray.limit);
        if (!hit) return std::nullopt;
        return Candidate{hit->t, what, *hit};
    }
    enter(ray, what.instance);
    constexpr double kRoundUp =
        1 + 1e-12;  // the limit is tested exactly in world coordinates afterwards
    const double local_limit = ray.limit / ray.local.size * kRoundUp;
    const auto hit = models_[ray.local_model].intersect(what.primitive, ray.local.origin,
                                                        ray.local.direction, local_limit);
    if (!hit) return std::nullopt;
    const double t = hit->t * ray.local.size;
    if (!(t <= ray.limit)) return std::nullopt;
    return Candidate{t, what, *hit};
}

void PlacedScene::begin(NearestRay& ray, const RaySegment& segment) {
    begin_tracing(ray, segment);
    ray.nearest.reset();
    ray.second = std::numeric_limits<double>::infinity();
    ray.all = nullptr;
    ray.out_of_memory = false;
}

bool PlacedScene::propose(NearestRay& ray, PrimitiveRef what) const {
    const std::optional<Candidate> candidate = cross(ray, what);
    if (!candidate) return false;
    if (ray.all) {
        collect(ray, *candidate);
        return false;
    }
    if (ray.nearest) {
        const Candidate& best = *ray.nearest;
        if (what == best.what) return false;
        const bool nearer = candidate->t < best.t || (candidate->t == best.t && what < best.what);
        ray.second = std::min(ray.second, nearer ? best.t : candidate->t);
        if (!nearer) return false;
    }
    ray.nearest = candidate;
    ray.limit = std::min(ray.limit, candidate->t + coincidence_);
    return true;
}

bool PlacedScene::is_ambiguous(const NearestRay& ray) const {
    if (!ray.nearest) return false;
    const PrimitiveRef what = ray.nearest->what;
    if (ray.second > ray.nearest->t + coincidence_) return false;
    const PlacedModel placed = paths_.at(what.instance);
    if (models_[placed.model].is_triangle(what.primitive))
        return false;  // tie rules do not apply inside meshes
    return ray.second <= ray.nearest->t + kEpsilon * placed.to_world.size();
}

void PlacedScene::begin_gathering(NearestRay& ray, const RaySegment& segment,
                                  const NearestRay& first, std::vector<Candidate>& all) const {
    begin(ray, segment);
    // The winner lies within one tolerance of the nearest crossing; its rivals lie within one more.
    ray.limit = std::min(ray.limit, first.nearest->t + 2 * coincidence_);
    ray.all = &all;
}

Precedence PlacedScene::precedence(const Candidate& candidate) const {
    const ModelPrimitives& model = model_of(candidate.what.instance);
    const std::uint32_t primitive = candidate.what.primitive;
    return precedence_of(model.traits(primitive), candidate.local.front, model.modifier(primitive),
                         model.surface(primitive));
}

Candidate PlacedScene::resolve(std::vector<Candidate>& all) const {
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.what.instance, a.t, a.what) < std::tie(b.what.instance, b.t, b.what);
    });
    Candidate winner;
    for (auto group = all.cbegin(); group != all.cend();) {
        const InstanceId instance = group->what.instance;
        const PlacedModel placed = paths_.at(instance);
        const ModelPrimitives& model = models_[placed.model];
        const double tied = group->t + kEpsilon * placed.to_world.size();
        Candidate best = *group;
        const bool has_ties = !model.is_triangle(best.what.primitive);
        for (; group != all.cend() && group->what.instance == instance; ++group) {
            if (has_ties && group->t <= tied && !model.is_triangle(group->what.primitive) &&
                precedence(*group) > precedence(best)) {
                best = *group;
            }
        }
        if (best.t < winner.t || winner.t >= kHuge) winner = best;
    }
    return winner;
}

Hit PlacedScene::hit_of(const RaySegment& segment, const Candidate& winner) const {
    const InstanceId instance = winner.what.instance;
    return instance == kWorld ? hit_in(world_, segment, winner)
                              : hit_in(paths_.at(instance), segment, winner);
}

/// The same, the model known that was hit.
Hit PlacedScene::hit_in(const PlacedModel& placed, const RaySegment& segment,
                        const Candidate& winner) const {
    const auto [instance, primitive] = winner.what;
    const ModelPrimitives& model = models_[placed.model];
    const Transform& to_world = placed.to_world;
    Hit hit;
    hit.t = winner.t;
    hit.position = fused_advance(segment.origin, segment.direction, winner.t);
    hit.normal = winner.local.normal;
    if (instance != kWorld) hit.normal = to_world.forward.vector(hit.normal) / to_world.size();
    hit.cos_out = -fused_dot(segment.direction, hit.normal);
    hit.surface = model.surface(primitive);
    hit.modifier = model.modifier(primitive);
    hit.instance = instance;
    if (model.is_triangle(primitive)) {
        const LocalRay local =
            local_ray(segment.origin, segment.direction, to_world.inverse, to_world.size());
        const Vec3 position = local.origin + local.direction * winner.local.t;
        const auto smoothing = model.smoothing(primitive, position, winner.local.normal);
        hit.perturbation = to_world.forward.vector(smoothing.perturbation) / to_world.size();
        hit.u = smoothing.u;
        hit.v = smoothing.v;
    }
    if (placed.override_surface != kNoSurface) {
        hit.surface = placed.override_surface;
        hit.modifier = surface(placed.override_surface).modifier();
        hit.instance = placed.override_instance;
    }
    return hit;
}

Hit PlacedScene::intersect_surface(SurfaceId id, const RaySegment& segment) const {
    Hit hit;
    const ModelPrimitives& own = models_[0];
    if (!own.is_finite(own.primitive_of(id))) return hit;
    const auto crossing = own.intersect(own.primitive_of(id), segment.origin, segment.direction,
                                        std::min(segment.t_max, kHuge));
    if (!crossing) return hit;
    hit.t = crossing->t;
    hit.position = fused_advance(segment.origin, segment.direction, hit.t);
    hit.normal = crossing->normal;
    hit.cos_out = -fused_dot(segment.direction, hit.normal);
    hit.surface = id;
    hit.modifier = surface(id).modifier();
    return hit;
}

void PlacedScene::begin(ShadowRay& ray, const RaySegment& segment, SurfaceId target) {
    begin_tracing(ray, segment);
    ray.t_max = ray.limit;
    ray.target = target;
    if (target != kNoSurface) ray.limit += kEpsilon + kSameCrossing;
    ray.result = Visibility::clear;
    ray.target_precedence.reset();
}

ShadowClass PlacedScene::shadow_class(const ShadowRay& ray, PrimitiveRef what) const {
    if (what.instance == kWorld) return models_[0].shadow(what.primitive);
    return ray.local_override != kNoSurface ? surface(ray.local_override).traits().shadow
                                            : models_[ray.local_model].shadow(what.primitive);
}

bool PlacedScene::meets_back(const ShadowRay& ray, const Candidate& candidate) {
    const bool placed = candidate.what.instance != kWorld;
    return fused_dot(placed ? ray.local.direction : ray.direction, candidate.local.normal) >= 0;
}

Obstacle PlacedScene::obstacle(ShadowRay& ray, const Candidate& candidate) const {
    if (ray.target == kNoSurface)
        return candidate.t < ray.t_max ? Obstacle::in_front : Obstacle::none;
    if (candidate.t < ray.t_max - coincidence_ - kSameCrossing) return Obstacle::in_front;
    return beside_target(ray, candidate);
}

/// The target is met if it is what `resolve` would choose. Of two surfaces this is decided here, by
/// the same rule; where rounding, a third surface or a placed model may have a say it is left open.
Obstacle PlacedScene::beside_target(ShadowRay& ray, const Candidate& candidate) const {
    const double ahead = ray.t_max - candidate.t;
    if (candidate.what.instance != kWorld)
        return ahead < -kSameCrossing ? Obstacle::none : Obstacle::unsure;
    if (ahead > kEpsilon + kSameCrossing) return Obstacle::in_front;
    if (hides_target(ray, candidate))
        return ahead >= -kSameCrossing ? Obstacle::in_front : Obstacle::unsure;
    return ahead > kEpsilon - kSameCrossing ? Obstacle::unsure : Obstacle::none;
}

/// Whether the crossing is preferred to the target where they coincide.
bool PlacedScene::hides_target(ShadowRay& ray, const Candidate& candidate) const {
    if (!ray.target_precedence) {
        const Hit on_target = intersect_surface(ray.target, {ray.origin, ray.direction, ray.limit});
        const Surface light = surface(ray.target);
        ray.target_precedence =
            precedence_of(light.traits(), on_target.cos_out > 0, light.modifier(), ray.target);
    }
    return precedence(candidate) > *ray.target_precedence;
}

bool PlacedScene::propose(ShadowRay& ray, PrimitiveRef what) const {
    if (what.instance == kWorld && models_[0].surface(what.primitive) == ray.target) return false;
    if (what.instance != kWorld) enter(ray, what.instance);
    // The crossing is tested first: most candidates are not met, and their traits lie elsewhere in
    // memory. After a surface that needs shading only opaque ones matter, which saves tests in
    // foliage.
    const bool passed_shaded = ray.result == Visibility::needs_shading;
    if (passed_shaded && shadow_class(ray, what) != ShadowClass::blocks) return false;
    const std::optional<Candidate> candidate = cross(ray, what);
    if (!candidate) return false;
    const ShadowClass shadow = shadow_class(ray, what);
    if (shadow == ShadowClass::ignored) return false;
    const Obstacle found = obstacle(ray, *candidate);
    if (found == Obstacle::none) return false;
    if (shadow == ShadowClass::clear_from_behind && found == Obstacle::in_front &&
        meets_back(ray, *candidate))
        return false;
    if (shadow != ShadowClass::blocks || found == Obstacle::unsure) {
        ray.result = Visibility::needs_shading;
        return false;
    }
    ray.result = Visibility::blocked;
    ray.blocker = what;
    return true;
}

}  // namespace lightwalk
