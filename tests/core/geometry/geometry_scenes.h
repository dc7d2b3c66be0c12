#pragma once
// Random scenes for the ray casting tests, and the slow way to cast a ray through them.
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/math/random.h"

namespace lightwalk::test {

inline Primitive primitive(PrimitiveType type, std::vector<double> reals) {
    Primitive result;
    result.type = type;
    result.name = "it";
    result.reals = std::move(reals);
    result.where = {"room.rad", 7};
    return result;
}

inline Surface surface(PrimitiveType type, std::vector<double> reals, int modifier,
                       SurfaceTraits traits) {
    ValidatedShape valid = make_shape(primitive(type, std::move(reals)));
    Surface result;
    result.type = valid.type;
    result.shape = std::move(valid.shape);
    result.modifier = ModifierId{modifier};
    result.traits = traits;
    return result;
}

inline constexpr SurfaceTraits kOpaque{true, false, ShadowClass::blocks};
inline constexpr SurfaceTraits kGlass{true, true, ShadowClass::special};
inline constexpr SurfaceTraits kNoMaterial{false, false, ShadowClass::ignored};

/// A similarity: scale, mirror along x, turn about an axis, move.
inline Transform similarity(double scale, bool mirror, const Vec3& axis, double angle,
                            const Vec3& move) {
    const Vec3 a = normalize(axis);
    const auto turn = [&](const Vec3& v) {  // Rodrigues
        return v * std::cos(angle) + cross(a, v) * std::sin(angle) +
               a * (dot(a, v) * (1 - std::cos(angle)));
    };
    Transform t;
    t.scale = mirror ? -scale : scale;
    const Vec3 x = turn({mirror ? -1.0 : 1.0, 0, 0}), y = turn({0, 1, 0}), z = turn({0, 0, 1});
    t.forward.row = {x * scale, y * scale, z * scale, move};
    const double s = 1 / scale;
    t.inverse.row = {Vec3{x.x, y.x, z.x} * s, Vec3{x.y, y.y, z.y} * s, Vec3{x.z, y.z, z.z} * s,
                     Vec3{}};
    t.inverse.row[3] = -t.inverse.vector(move);
    return t;
}

/// Surfaces and models that outlive the Geometry built from them.
struct TestModels {
    std::vector<Surface> surfaces;
    std::vector<ModelGeometry> models = std::vector<ModelGeometry>(1);
    std::vector<MeshModel> meshes;

    SurfaceId add(Surface s, std::size_t model = 0) {
        const SurfaceId id{static_cast<std::int32_t>(surfaces.size())};
        surfaces.push_back(std::move(s));
        if (!std::holds_alternative<std::monostate>(surfaces.back().shape))
            models[model].surfaces.push_back(id);
        return id;
    }
    void place(std::size_t model, std::size_t in, const Transform& transform,
               bool overrides = false, int modifier = -1) {
        Surface s;
        s.type = PrimitiveType::instance;
        s.modifier = ModifierId{modifier};
        s.traits = overrides ? kOpaque : kNoMaterial;
        const SurfaceId id{static_cast<std::int32_t>(surfaces.size())};
        surfaces.push_back(s);
        models[in].placements.push_back(
            {static_cast<std::uint32_t>(model), transform, id, overrides});
    }
    [[nodiscard]] Geometry build(const std::string& embree_options = {}) const {
        return Geometry({surfaces, models}, embree_options);
    }
};

class Random {
  public:
    explicit Random(std::uint64_t seed) : stream_(RandomStream::of_pixel(seed, 0, 0, 0)) {}
    double uniform(double low, double high) { return low + (high - low) * stream_.next(); }
    int below(int n) { return static_cast<int>(stream_.next() * n); }
    Vec3 in_box(double half) {
        return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = in_box(1);
            if (const double n = length(v); n > 0.1 && n <= 1) return v / n;
        }
    }
    /// A corner of a coarse grid, so that surfaces touch and coincide.
    Vec3 on_grid(int half) {
        const auto one = [&] { return 0.5 * (below(4 * half + 1) - 2 * half); };
        const double x = one(), y = one(), z = one();
        return {x, y, z};
    }

  private:
    RandomStream stream_;
};

inline SurfaceTraits random_traits(Random& random) {
    const int kind = random.below(4);
    return kind == 0 ? kNoMaterial : kind == 1 ? kGlass : kOpaque;
}

/// A rectangle between two grid corners, perpendicular to an axis: many of them share planes, edges
/// and corners.
inline std::vector<double> grid_rectangle(Random& random) {
    const auto axis = static_cast<std::size_t>(random.below(3)), u = (axis + 1) % 3,
               v = (axis + 2) % 3;
    const Vec3 a = random.on_grid(2);
    Vec3 size;
    size[u] = 0.5 * (1 + random.below(4));
    size[v] = 0.5 * (1 + random.below(4));
    Vec3 corners[4] = {a, a, a, a};
    corners[1][u] += size[u];
    corners[2] += size;
    corners[3][v] += size[v];
    if (random.below(2) == 0) std::swap(corners[1], corners[3]);
    std::vector<double> reals;
    for (const Vec3& p : corners) reals.insert(reals.end(), {p.x, p.y, p.z});
    return reals;
}

inline std::vector<double> star_polygon(Random& random, int corners) {
    const Vec3 center = random.in_box(2), x = random.direction(), y = perpendicular(x);
    std::vector<double> reals;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * kPi * i / corners, r = random.uniform(0.2, 1.5);
        const Vec3 p = center + x * (r * std::cos(angle)) + y * (r * std::sin(angle));
        reals.insert(reals.end(), {p.x, p.y, p.z});
    }
    return reals;
}

inline Surface random_surface(Random& random) {
    const Vec3 p = random.on_grid(2), q = p + random.in_box(1), n = random.direction();
    const SurfaceTraits traits = random_traits(random);
    const int modifier = random.below(5);
    const double r = random.uniform(0.1, 0.8), s = random.uniform(0.1, 0.8);
    using enum PrimitiveType;
    switch (random.below(11)) {
        case 0:
            return surface(sphere, {p.x, p.y, p.z, r}, modifier, traits);
        case 1:
            return surface(bubble, {p.x, p.y, p.z, r}, modifier, traits);
        case 2:
            return surface(cone, {p.x, p.y, p.z, q.x, q.y, q.z, r, s}, modifier, traits);
        case 3:
            return surface(cup, {p.x, p.y, p.z, q.x, q.y, q.z, 0, s}, modifier, traits);
        case 4:
            return surface(cylinder, {p.x, p.y, p.z, q.x, q.y, q.z, r}, modifier, traits);
        case 5:
            return surface(tube, {p.x, p.y, p.z, q.x, q.y, q.z, r}, modifier, traits);
        case 6:
            return surface(ring, {p.x, p.y, p.z, n.x, n.y, n.z, 0.4 * r, r}, modifier, traits);
        case 7:
            return surface(polygon, star_polygon(random, 3 + random.below(90)), modifier, traits);
        default:
            return surface(polygon, grid_rectangle(random), modifier, traits);
    }
}

/// Two levels of placed models under a scene, all of random surfaces; some placements override,
/// some mirror.
inline TestModels random_models(std::uint64_t seed, int surfaces_per_model) {
    Random random(seed);
    TestModels scene;
    scene.models.resize(3);
    for (std::size_t model = 0; model < 3; ++model) {
        for (int i = 0; i < surfaces_per_model; ++i) scene.add(random_surface(random), model);
    }
    const auto transform = [&](double scale) {
        return similarity(random.uniform(0.5, 1) * scale, random.below(2) == 0, random.direction(),
                          random.uniform(0, 6), random.in_box(2));
    };
    for (int i = 0; i < 3; ++i) scene.place(2, 1, transform(0.4), i == 1, 3);
    for (int i = 0; i < 3; ++i) scene.place(1, 0, transform(0.6), i == 2, 2);
    scene.place(2, 0, transform(3));
    scene.place(2, 0, Transform{});
    return scene;
}

/// Casting rays by trying everything, recursively through the placements.
class BruteForce {
  public:
    explicit BruteForce(const TestModels& scene) : scene_(scene) {}

    struct Best {
        double t = kHuge;
        Vec3 normal;  ///< world
        SurfaceId surface = kNoSurface;
        ModifierId modifier = kVoid;
        FrameId frame = kWorld;
        [[nodiscard]] bool exists() const { return surface != kNoSurface; }
    };

    [[nodiscard]] Best nearest(const RaySegment& ray) {
        next_frame_ = 0;
        best_ = {};
        visit(0, Transform{}, kWorld, nullptr, kWorld, ray);
        return best_;
    }
    [[nodiscard]] Visibility visibility(const RaySegment& ray, SurfaceId target) {
        Visibility result = Visibility::clear;
        visit_shadow(0, Transform{}, nullptr, ray, target, result);
        return result;
    }

  private:
    struct Crossing {
        double t;
        ShapeHit hit;
        SurfaceId id;
    };
    [[nodiscard]] const Surface& at(SurfaceId id) const {
        return scene_.surfaces[static_cast<std::size_t>(index(id))];
    }

    /// Every crossing of a model's own surfaces up to t_max.
    [[nodiscard]] std::vector<Crossing> crossings(std::size_t model, const Transform& place,
                                                  const RaySegment& ray) const {
        const bool moved = !place.is_identity();
        const Vec3 o = moved ? place.inverse.point(ray.origin) : ray.origin;
        const Vec3 d = moved ? place.inverse.vector(ray.direction) * place.size() : ray.direction;
        std::vector<Crossing> all;
        for (const SurfaceId id : scene_.models[model].surfaces) {
            const auto hit = intersect(at(id).shape, o, d, kHuge);
            if (hit && hit->t * place.size() <= ray.t_max)
                all.push_back({hit->t * place.size(), *hit, id});
        }
        return all;
    }
    /// Whether the first of two coincident crossings is seen.
    [[nodiscard]] bool beats(const Crossing& a, const Crossing& b) const {
        const Surface &s = at(a.id), &r = at(b.id);
        if (s.traits.has_material != r.traits.has_material) return s.traits.has_material;
        if (s.traits.transparent != r.traits.transparent) return r.traits.transparent;
        if (a.hit.front != b.hit.front) return a.hit.front;
        if (s.modifier != r.modifier) return index(s.modifier) > index(r.modifier);
        return index(a.id) > index(b.id);
    }
    void visit(std::size_t model, const Transform& place, FrameId frame,
               const Placement* override_by, FrameId override_frame, const RaySegment& ray) {
        const std::vector<Crossing> all = crossings(model, place, ray);
        double least = kHuge;
        for (const Crossing& c : all) least = std::min(least, c.t);
        const Crossing* winner = nullptr;
        for (const Crossing& c : all) {
            if (c.t <= least + kEpsilon * place.size() && (!winner || beats(c, *winner)))
                winner = &c;
        }
        if (winner && winner->t < best_.t) {
            const SurfaceId seen = override_by ? override_by->surface : winner->id;
            best_ = {winner->t, place.forward.vector(winner->hit.normal) / place.size(), seen,
                     at(seen).modifier, override_by ? override_frame : frame};
        }
        for (const Placement& p : scene_.models[model].placements) {
            const FrameId inner{next_frame_++};
            const bool overrides = !override_by && p.overrides;
            visit(p.model, p.transform * place, inner, overrides ? &p : override_by,
                  overrides ? frame : override_frame, ray);
        }
    }
    void visit_shadow(std::size_t model, const Transform& place, const Placement* override_by,
                      const RaySegment& ray, SurfaceId target, Visibility& result) const {
        for (const Crossing& c : crossings(model, place, ray)) {
            const ShadowClass shadow = at(override_by ? override_by->surface : c.id).traits.shadow;
            if (c.id == target || c.t >= ray.t_max || shadow == ShadowClass::ignored) continue;
            if (shadow == ShadowClass::blocks)
                result = Visibility::blocked;
            else if (result == Visibility::clear)
                result = Visibility::special;
        }
        for (const Placement& p : scene_.models[model].placements) {
            visit_shadow(p.model, p.transform * place,
                         !override_by && p.overrides ? &p : override_by, ray, target, result);
        }
    }

    const TestModels& scene_;
    std::int32_t next_frame_ = 0;
    Best best_;
};

}  // namespace lightwalk::test
