#pragma once
// Random scenes for tests of ray casting, and a reference that casts rays through them by brute
// force.
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/math/random.h"
#include "tests/all_primitives.h"

namespace lightwalk::test {

inline Primitive primitive(PrimitiveType type, std::vector<double> reals) {
    Primitive result;
    result.type = type;
    result.name = "it";
    result.reals = std::move(reals);
    result.where = {"room.rad", 7};
    return result;
}

/// A primitive that is kept until the program ends, as shapes refer to its numbers.
inline SurfacePrimitive kept_primitive(PrimitiveType type, std::vector<double> reals) {
    static std::deque<Primitive> all;
    return view_of(all.emplace_back(primitive(type, std::move(reals))));
}

inline constexpr SurfaceTraits kOpaque{true, false, ShadowClass::blocks};
inline constexpr SurfaceTraits kGlass{true, true, ShadowClass::needs_shading};
inline constexpr SurfaceTraits kIllum{true, false, ShadowClass::clear_from_behind};
inline constexpr SurfaceTraits kNoMaterial{false, false, ShadowClass::ignored};

/// Traits belong to modifiers, so each number stands for four modifiers, one for each kind of
/// traits.
inline ModifierId modifier_of(int number, const SurfaceTraits& traits) {
    const int kind = !traits.has_material                              ? 0
                     : traits.transparent                              ? 1
                     : traits.shadow == ShadowClass::clear_from_behind ? 3
                                                                       : 2;
    return number < 0 ? kVoid : ModifierId{4 * number + kind};
}
/// The traits of all modifiers that modifier_of returns for numbers below 1000; void has none.
inline ModifierTraits test_traits() {
    std::vector<SurfaceTraits> traits;
    for (int number = 0; number < 1000; ++number)
        traits.insert(traits.end(), {kNoMaterial, kGlass, kOpaque, kIllum});
    return {traits, kNoMaterial};
}

/// A surface of a test scene.
struct TestSurface : Primitive {
    [[nodiscard]] SurfaceTraits traits() const { return test_traits()[ModifierId{modifier}]; }
};

inline TestSurface surface(PrimitiveType type, std::vector<double> reals, int number,
                           SurfaceTraits traits) {
    TestSurface result;
    static_cast<Primitive&>(result) = primitive(type, std::move(reals));
    result.modifier = index(modifier_of(number, traits));
    return result;
}

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

class BuiltGeometry;

/// Models, and what a Geometry is built from.
struct TestModels {
    struct Contents {
        std::vector<TestSurface> surfaces;
        ModelGeometry geometry;  ///< placements name surfaces by their numbers in this model
    };
    std::vector<Contents> models = std::vector<Contents>(1);

    /// Returns the surface's id, as long as the model is the first, or no other grows before it.
    SurfaceId add(TestSurface s, std::size_t model = 0) {
        models[model].surfaces.push_back(std::move(s));
        return SurfaceId{static_cast<std::int32_t>(models[model].surfaces.size()) - 1};
    }
    void place(std::size_t model, std::size_t in, const Transform& transform,
               bool overrides = false, int modifier = 0) {
        TestSurface s;
        s.type = PrimitiveType::instance;
        s.modifier = index(overrides ? modifier_of(modifier, kOpaque) : kVoid);
        const SurfaceId id = add(std::move(s), in);
        models[in].geometry.placements.push_back(
            {static_cast<std::uint32_t>(model), transform, id, overrides});
    }
    /// Id of the first surface of a model.
    [[nodiscard]] std::int32_t first_of(std::size_t model) const {
        std::size_t first = 0;
        for (std::size_t i = 0; i < model; ++i) first += models[i].surfaces.size();
        return static_cast<std::int32_t>(first);
    }
    /// The placements of a model, with the ids of their surfaces.
    [[nodiscard]] std::vector<Placement> placements(std::size_t model) const {
        std::vector<Placement> all = models[model].geometry.placements;
        for (Placement& p : all) p.surface = SurfaceId{first_of(model) + index(p.surface)};
        return all;
    }

    /// The tables that a Geometry looks at, and the Geometry's input.
    struct Tables {
        explicit Tables(const TestModels& scene)
            : lists(scene.models.size()), shapes(scene.models.size()) {
            for (std::size_t i = 0; i < scene.models.size(); ++i) {
                for (const TestSurface& s : scene.models[i].surfaces) lists[i].add(s);
                shapes[i] = make_shapes(lists[i], SerialTaskRunner());
                ModelGeometry model = scene.models[i].geometry;
                model.placements = scene.placements(i);
                model.part = surfaces.add(lists[i], shapes[i], 0);
                for (MeshPart& part : model.meshes) part.surface = surfaces.part(model.part).id(0);
                input.models.push_back(std::move(model));
            }
            surfaces.set_traits(test_traits());
            input.surfaces = &surfaces;
        }
        Tables(const Tables&) = delete;
        Tables& operator=(const Tables&) = delete;

        std::vector<SurfaceList> lists;
        std::vector<SurfaceShapes> shapes;
        SurfaceTable surfaces;
        GeometryInput input;
    };
    [[nodiscard]] BuiltGeometry build(const std::string& embree_options = {}) const;
};

/// A Geometry together with the tables that it refers to.
class BuiltGeometry : private std::unique_ptr<TestModels::Tables>, private Geometry {
  public:
    BuiltGeometry(std::unique_ptr<TestModels::Tables> tables, const std::string& embree_options)
        : std::unique_ptr<TestModels::Tables>(std::move(tables)),
          Geometry((**this).input, embree_options) {}
    using Geometry::bounds, Geometry::instance_transform, Geometry::instance_count,
        Geometry::intersect, Geometry::intersect_surface, Geometry::memory, Geometry::visibility;
};

inline BuiltGeometry TestModels::build(const std::string& embree_options) const {
    return {std::make_unique<Tables>(*this), embree_options};
}

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

inline TestSurface random_surface(Random& random) {
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

/// Casts rays by testing all surfaces, recursively through the placements.
class BruteForce {
  public:
    explicit BruteForce(const TestModels& scene) : scene_(scene), tables_(scene) {}

    struct Best {
        double t = kHuge;
        Vec3 normal;  ///< world
        SurfaceId surface = kNoSurface;
        ModifierId modifier = kVoid;
        InstanceId instance = kWorld;
        [[nodiscard]] bool exists() const { return surface != kNoSurface; }
    };

    [[nodiscard]] Best nearest(const RaySegment& ray) {
        next_instance_ = 0;
        best_ = {};
        visit(0, Transform{}, kWorld, nullptr, kWorld, ray);
        return best_;
    }
    /// Of what lies before ray.t_max.
    [[nodiscard]] Visibility visibility(const RaySegment& ray) {
        Visibility result = Visibility::clear;
        visit_shadow(0, Transform{}, nullptr, ray, result);
        return result;
    }

  private:
    struct Crossing {
        double t;
        ShapeHit hit;
        SurfaceId id;
    };
    [[nodiscard]] Surface at(SurfaceId id) const { return tables_.surfaces[id]; }

    /// Every crossing of a model's own surfaces up to t_max.
    [[nodiscard]] std::vector<Crossing> crossings(std::size_t model, const Transform& place,
                                                  const RaySegment& ray) const {
        const bool moved = !place.is_identity();
        const Vec3 o = moved ? place.inverse.point(ray.origin) : ray.origin;
        const Vec3 d = moved ? place.inverse.vector(ray.direction) * place.size() : ray.direction;
        std::vector<Crossing> all;
        for (std::size_t i = 0; i < scene_.models[model].surfaces.size(); ++i) {
            const SurfaceId id = tables_.surfaces.part(model).id(i);
            const auto hit = intersect(at(id).shape(), o, d, kHuge);
            if (hit && hit->t * place.size() <= ray.t_max)
                all.push_back({hit->t * place.size(), *hit, id});
        }
        return all;
    }
    /// Whether the first of two coincident crossings is seen.
    [[nodiscard]] bool beats(const Crossing& a, const Crossing& b) const {
        const Surface s = at(a.id), r = at(b.id);
        if (s.traits().has_material != r.traits().has_material) return s.traits().has_material;
        if (s.traits().transparent != r.traits().transparent) return r.traits().transparent;
        if (a.hit.front != b.hit.front) return a.hit.front;
        if (s.modifier() != r.modifier()) return index(s.modifier()) > index(r.modifier());
        return index(a.id) > index(b.id);
    }
    void visit(std::size_t model, const Transform& place, InstanceId instance,
               const Placement* override_by, InstanceId override_instance, const RaySegment& ray) {
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
                     at(seen).modifier(), override_by ? override_instance : instance};
        }
        for (const Placement& p : tables_.input.models[model].placements) {
            const InstanceId inner{next_instance_++};
            const bool overrides = !override_by && p.overrides;
            visit(p.model, p.transform * place, inner, overrides ? &p : override_by,
                  overrides ? instance : override_instance, ray);
        }
    }
    void visit_shadow(std::size_t model, const Transform& place, const Placement* override_by,
                      const RaySegment& ray, Visibility& result) const {
        for (const Crossing& c : crossings(model, place, ray)) {
            const ShadowClass shadow =
                at(override_by ? override_by->surface : c.id).traits().shadow;
            if (c.t >= ray.t_max || shadow == ShadowClass::ignored) continue;
            if (shadow == ShadowClass::blocks)
                result = Visibility::blocked;
            else if (result == Visibility::clear)
                result = Visibility::needs_shading;
        }
        for (const Placement& p : tables_.input.models[model].placements) {
            visit_shadow(p.model, p.transform * place,
                         !override_by && p.overrides ? &p : override_by, ray, result);
        }
    }

    const TestModels& scene_;
    const TestModels::Tables tables_;
    std::int32_t next_instance_ = 0;
    Best best_;
};

}  // namespace lightwalk::test
