#include "core/geometry/geometry.h"

#include <doctest/doctest.h>

#include <bit>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "tests/core/geometry/geometry_scenes.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Rays from everywhere to everywhere: also along axes, through corners of the grid, and from far
/// away.
std::vector<RaySegment> test_rays(std::uint64_t seed, int count) {
    Random random(seed);
    std::vector<RaySegment> rays;
    for (int i = 0; i < count; ++i) {
        RaySegment ray;
        ray.origin = random.below(3) == 0 ? random.on_grid(3) : random.in_box(4);
        if (random.below(20) == 0) ray.origin = ray.origin * 1e6;
        switch (random.below(3)) {
            case 0:
                ray.direction = random.direction();
                break;
            case 1:
                ray.direction = normalize(random.on_grid(2) - ray.origin);
                break;
            default: {
                Vec3 axis;
                axis[static_cast<std::size_t>(random.below(3))] = random.below(2) == 0 ? 1 : -1;
                ray.direction = axis;
            }
        }
        if (ray.direction == Vec3{}) ray.direction = {1, 0, 0};
        if (random.below(4) == 0) ray.t_max = random.uniform(0, 6);
        rays.push_back(ray);
    }
    return rays;
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const Vec3& a, const Vec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const Hit& a, const Hit& b) {
    return same_bits(a.t, b.t) && same_bits(a.position, b.position) &&
           same_bits(a.normal, b.normal) && same_bits(a.cos_out, b.cos_out) &&
           same_bits(a.perturbation, b.perturbation) && same_bits(a.u, b.u) &&
           same_bits(a.v, b.v) && a.surface == b.surface && a.modifier == b.modifier &&
           a.instance == b.instance;
}

/// With the instructions that Embree would use on another processor; nothing where this one lacks
/// them.
std::optional<BuiltGeometry> built_for(const TestModels& scene, const std::string& instructions) {
    try {
        return scene.build("isa=" + instructions);
    } catch (const std::runtime_error& error) {
        CHECK(std::string(error.what()) == "Embree does not start on this machine");
        MESSAGE("skipped: this processor has no " << instructions);
        return std::nullopt;
    }
}

/// A unit square at height z, facing up.
std::vector<double> square(double z) {
    return {0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z};
}
std::vector<double> facing_down(double z) {
    return {0, 0, z, 0, 1, z, 1, 1, z, 1, 0, z};
}
const RaySegment kDown{{0.3, 0.4, 5}, {0, 0, -1}};

SurfaceId seen_of(const TestSurface& first, const TestSurface& second) {
    TestModels scene;
    scene.add(first);
    scene.add(second);
    return scene.build().intersect(kDown).surface;
}

}  // namespace

TEST_CASE("the nearest hit is the one that trying every surface gives") {
    for (const int surfaces : {3, 12, 60}) {
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            CAPTURE(surfaces);
            CAPTURE(seed);
            const TestModels scene = random_models(seed, surfaces);
            const BuiltGeometry geometry = scene.build();
            BruteForce brute(scene);
            int hits = 0;
            for (const RaySegment& ray : test_rays(seed + 100, 700)) {
                const Hit hit = geometry.intersect(ray);
                const BruteForce::Best expected = brute.nearest(ray);
                REQUIRE(hit.exists() == expected.exists());
                if (!hit.exists()) continue;
                ++hits;
                REQUIRE(same_bits(hit.t, expected.t));
                REQUIRE(hit.surface == expected.surface);
                REQUIRE(hit.modifier == expected.modifier);
                REQUIRE(hit.instance == expected.instance);
                CHECK(length(hit.normal - expected.normal) < kRounding);
                CHECK(std::abs(length(hit.normal) - 1) < kRounding);
                CHECK(length(hit.position - (ray.origin + ray.direction * hit.t)) <
                      kFewRoundings * (hit.t + 10));
                CHECK(hit.cos_out == rounded(-dot(ray.direction, hit.normal)));
            }
            CHECK(hits > 40);
        }
    }
}

TEST_CASE("Embree proposes, doubles decide: hits are the same bits whatever instructions it uses") {
    for (const std::string instructions : {"sse2", "sse4.2", "avx", "avx2", "avx512"}) {
        CAPTURE(instructions);
        for (std::uint64_t seed = 20; seed < 24; ++seed) {
            const TestModels scene = random_models(seed, 40);
            const std::optional<BuiltGeometry> other = built_for(scene, instructions);
            if (!other) break;
            const BuiltGeometry geometry = scene.build();
            const std::vector<RaySegment> rays = test_rays(seed, 1000);
            std::vector<Hit> hits(rays.size()), other_hits(rays.size());
            geometry.intersect(rays, hits);
            other->intersect(rays, other_hits);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                REQUIRE(same_bits(other_hits[i], hits[i]));
                REQUIRE(same_bits(other->intersect(rays[i]), hits[i]));
                REQUIRE(other->visibility(rays[i], kNoSurface) ==
                        geometry.visibility(rays[i], kNoSurface));
            }
        }
    }
}

TEST_CASE("packets give the same bits as single rays, whatever travels beside them") {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        // Machines without AVX-512 cut packets up, those without AVX into groups of four.
        constexpr std::array<const char*, 3> kMachines{"", "isa=avx2", "isa=sse4.2"};
        const TestModels scene = random_models(seed, 40);
        const BuiltGeometry geometry = scene.build(kMachines[seed % kMachines.size()]);
        std::vector<RaySegment> rays = test_rays(seed, 1003);
        for (int x = 0; x < 40; ++x) {  // and coherent ones
            for (int y = 0; y < 40; ++y) {
                rays.push_back(
                    {{0.1, 0.2, 4}, normalize(Vec3{0.02 * x - 0.4, 0.02 * y - 0.4, -1})});
            }
        }
        for (const std::size_t offset : {0U, 5U}) {
            std::vector<Hit> hits(rays.size() - offset);
            geometry.intersect(std::span(rays).subspan(offset), hits);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                REQUIRE(same_bits(hits[i], geometry.intersect(rays[i + offset])));
            }
        }
    }
}

TEST_CASE("visibility is what trying every surface gives") {
    int found[3] = {};
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const TestModels scene = random_models(seed, seed < 4 ? 2 : 15);
        const BuiltGeometry geometry = scene.build();
        BruteForce brute(scene);
        Random random(seed);
        for (RaySegment ray : test_rays(seed + 50, 500)) {
            ray.t_max = random.uniform(0, 8);
            const Visibility v = geometry.visibility(ray, kNoSurface);
            REQUIRE(v == brute.visibility(ray));
            ++found[static_cast<int>(v)];
        }
    }
    for (const int count : found) CHECK(count > 100);
}

TEST_CASE("shadow rays in packets find what single ones find, whatever blocked earlier ones") {
    int found[3] = {}, cached = 0;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        constexpr std::array<const char*, 3> kMachines{"", "isa=avx2", "isa=sse4.2"};
        const TestModels scene = random_models(seed, seed < 3 ? 2 : 25);
        const BuiltGeometry geometry = scene.build(kMachines[seed % kMachines.size()]);
        Random random(seed);
        std::array<Blocker, 3> last;
        std::vector<ShadowQuery> queries;
        for (RaySegment ray : test_rays(seed + 70, 803)) {
            ray.t_max = random.uniform(0, 8);
            ShadowQuery query{ray, kNoSurface, nullptr};
            const Hit target = geometry.intersect_surface(SurfaceId{0}, ray);
            if (target.exists()) {
                query.target = SurfaceId{0};
                query.ray.t_max = target.t;
            }
            if (const auto which = static_cast<std::size_t>(random.below(4)); which < last.size())
                query.last = &last[which];
            queries.push_back(query);
        }
        for (const std::size_t offset : {0U, 3U}) {
            const auto some = std::span(queries).subspan(offset);
            std::vector<Visibility> answers(some.size());
            geometry.visibility(some, answers);
            for (std::size_t i = 0; i < some.size(); ++i) {
                REQUIRE(answers[i] == geometry.visibility(some[i].ray, some[i].target));
                ++found[static_cast<int>(answers[i])];
            }
        }
        for (const Blocker& blocker : last) cached += blocker.primitive != Blocker::kNone ? 1 : 0;
    }
    for (const int count : found) CHECK(count > 100);
    CHECK(cached > 12);
}

TEST_CASE(
    "of coincident surfaces a material beats none, then opaque beats transparent, then front beats "
    "back, "
    "then the later modifier, then the later surface") {
    using enum PrimitiveType;
    const auto make = [](bool front, int modifier, SurfaceTraits traits, double z = 0) {
        return surface(polygon, front ? square(z) : facing_down(z), modifier, traits);
    };
    constexpr SurfaceId first{0}, second{1};
    // each pair in both orders; where a rule decides, every later rule speaks for the other surface
    const TestSurface back_glass = make(false, 1, kGlass), front_void = make(true, 5, kNoMaterial);
    CHECK(seen_of(back_glass, front_void) == first);
    CHECK(seen_of(front_void, back_glass) == second);
    const TestSurface back_opaque = make(false, 1, kOpaque), front_glass = make(true, 5, kGlass);
    CHECK(seen_of(back_opaque, front_glass) == first);
    CHECK(seen_of(front_glass, back_opaque) == second);
    const TestSurface front_early = make(true, 1, kOpaque), back_late = make(false, 5, kOpaque);
    CHECK(seen_of(front_early, back_late) == first);
    CHECK(seen_of(back_late, front_early) == second);
    const TestSurface early = make(true, 1, kOpaque), late = make(true, 5, kOpaque);
    CHECK(seen_of(late, early) == first);
    CHECK(seen_of(early, late) == second);
    CHECK(seen_of(early, early) == second);

    // coincident means within 1e-6, no more
    CHECK(seen_of(make(true, 5, kOpaque, 0), make(true, 1, kOpaque, 0.9e-6)) == first);
    CHECK(seen_of(make(true, 5, kOpaque, 0), make(true, 1, kOpaque, 1.1e-6)) == second);
}

TEST_CASE("ties do not depend on the order of a chain of nearly coincident surfaces") {
    // 0 and 2 are further than the tolerance apart: the best within it of the nearest one wins.
    TestModels scene;
    for (const int i : {2, 0, 1, 3}) {
        scene.add(surface(PrimitiveType::polygon, square(1e-6 * -0.7 * i), i, kOpaque));
    }
    const Hit hit = scene.build().intersect(kDown);
    CHECK(hit.modifier == modifier_of(1, kOpaque));
    CHECK(hit.surface == SurfaceId{2});
}

TEST_CASE("a surface that ends less than a millionth of the distance before the ray does is hit") {
    TestModels scene;
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kOpaque));
    const BuiltGeometry geometry = scene.build();
    CHECK(geometry.intersect({{0.3, 0.4, 5}, {0, 0, -1}, 5}).exists());
    CHECK_FALSE(geometry.intersect({{0.3, 0.4, 5}, {0, 0, -1}, 5 - 1e-9}).exists());
    CHECK_FALSE(geometry.intersect({{0.3, 0.4, 1e-6}, {0, 0, -1}}).exists());
    CHECK(geometry.intersect({{0.3, 0.4, 1.001e-6}, {0, 0, -1}}).exists());
}

TEST_CASE("a placed model wins only where it is strictly nearer, its own ties are its own") {
    TestModels scene;
    scene.models.resize(2);
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kGlass));
    scene.add(surface(PrimitiveType::polygon, square(0), 7, kOpaque), 1);
    scene.place(1, 0, Transform{});
    CHECK(scene.build().intersect(kDown).surface == SurfaceId{0});
    scene.models[0].geometry.placements[0].transform =
        similarity(1, false, {0, 0, 1}, 0, {0, 0, 1e-9});
    const Hit hit = scene.build().intersect(kDown);
    CHECK(hit.surface == SurfaceId{2});  // of its own; 1 is the placement
    CHECK(hit.instance == InstanceId{0});
}

TEST_CASE("a mirrored placement shows the mirror image of the normal") {
    TestModels scene;
    scene.models.resize(2);
    scene.add(surface(PrimitiveType::polygon, {0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1}, 0, kOpaque),
              1);  // normal +x
    const Transform mirror = similarity(2, true, {0, 0, 1}, 0, {3, 0, 0});
    CHECK(mirror.scale == -2);
    scene.place(1, 0, mirror);
    const BuiltGeometry geometry = scene.build();
    const Hit hit = geometry.intersect({{0, 1, 1}, {1, 0, 0}});
    REQUIRE(hit.exists());
    CHECK(hit.t == rounded(3));
    CHECK(length(hit.normal - Vec3{-1, 0, 0}) < kFewRoundings);
    CHECK(hit.cos_out == rounded(1));
    CHECK(geometry.instance_transform(hit.instance).scale == -2);
}

TEST_CASE(
    "the outermost placement with a modifier shades everything inside, in the space it stands in") {
    TestModels scene;
    scene.models.resize(4);
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kGlass), 3);
    const auto up = [](double z) { return similarity(1, false, {0, 0, 1}, 0, {0, 0, z}); };
    scene.place(3, 2, up(1), true, 11);   // surface 2, overruled
    scene.place(2, 1, up(10), true, 12);  // surface 1
    scene.place(1, 0, up(100));           // surface 0
    const BuiltGeometry geometry = scene.build();
    REQUIRE(geometry.instance_count() == 3);
    const Hit hit = geometry.intersect({{0.3, 0.4, 200}, {0, 0, -1}});
    CHECK(hit.t == rounded(89));
    CHECK(hit.surface == SurfaceId{1});
    CHECK(hit.modifier == modifier_of(12, kOpaque));
    CHECK(hit.instance == InstanceId{0});  // model 1's, where the overriding placement stands
    CHECK(geometry.instance_transform(hit.instance).forward.row[3] == Vec3{0, 0, 100});
    CHECK(geometry.instance_transform(InstanceId{2}).forward.row[3] == Vec3{0, 0, 111});
    CHECK(geometry.visibility({{0.3, 0.4, 200}, {0, 0, -1}}, kNoSurface) == Visibility::blocked);
}

TEST_CASE(
    "the light's own surface does not shadow it, a coincident one does where it would be seen "
    "instead") {
    TestModels scene;
    const SurfaceId light = scene.add(surface(PrimitiveType::polygon, square(0), 3, kOpaque));
    const RaySegment to_light{{0.3, 0.4, 5}, {0, 0, -1}, 5};
    CHECK(scene.build().visibility(to_light, light) == Visibility::clear);
    CHECK(scene.build().visibility({{0.3, 0.4, 5}, {0, 0, -1}, 6}, kNoSurface) ==
          Visibility::blocked);

    TestModels earlier = scene, later = scene, pane = scene, behind = scene;
    earlier.add(surface(PrimitiveType::polygon, square(0), 2, kOpaque));
    later.add(surface(PrimitiveType::polygon, square(0), 4, kOpaque));
    pane.add(surface(PrimitiveType::polygon, square(0), 4, kGlass));
    behind.add(surface(PrimitiveType::polygon, square(-1e-5), 4, kOpaque));
    CHECK(earlier.build().visibility(to_light, light) == Visibility::clear);
    CHECK(later.build().visibility(to_light, light) == Visibility::blocked);
    CHECK(pane.build().visibility(to_light, light) == Visibility::clear);
    CHECK(behind.build().visibility(to_light, light) == Visibility::clear);
}

TEST_CASE("an opaque surface blocks whatever glass stands before or behind it") {
    for (const bool glass_first : {false, true}) {
        TestModels scene;
        scene.add(surface(PrimitiveType::polygon, square(glass_first ? 3 : 1), 0, kGlass));
        CHECK(scene.build().visibility(kDown, kNoSurface) == Visibility::needs_shading);
        scene.add(surface(PrimitiveType::polygon, square(2), 0, kOpaque));
        CHECK(scene.build().visibility(kDown, kNoSurface) == Visibility::blocked);
    }
    TestModels invisible;
    invisible.add(surface(PrimitiveType::polygon, square(1), -1, kNoMaterial));
    CHECK(invisible.build().visibility(kDown, kNoSurface) == Visibility::clear);
}

TEST_CASE("an illum without an alternate is not there for shadow rays that meet its back") {
    TestModels scene;  // its front is above
    scene.add(surface(PrimitiveType::polygon, square(2), 0, kIllum));
    const RaySegment up{{0.1, 0.2, 0}, {0, 0, 1}, kHuge};
    CHECK(scene.build().visibility(up, kNoSurface) == Visibility::clear);
    CHECK(scene.build().visibility(kDown, kNoSurface) == Visibility::needs_shading);
    TestModels pane = scene, wall = scene;
    pane.add(surface(PrimitiveType::polygon, square(3), 0, kGlass));
    CHECK(pane.build().visibility(up, kNoSurface) == Visibility::needs_shading);
    wall.add(surface(PrimitiveType::polygon, square(3), 0, kOpaque));
    CHECK(wall.build().visibility(up, kNoSurface) == Visibility::blocked);
}

TEST_CASE("one surface alone can be asked for") {
    TestModels scene;
    scene.add(surface(PrimitiveType::polygon, square(3), 4, kOpaque));
    const SurfaceId low = scene.add(surface(PrimitiveType::polygon, square(1), 6, kOpaque));
    const BuiltGeometry geometry = scene.build();
    const Hit hit = geometry.intersect_surface(low, kDown);
    CHECK(hit.surface == low);
    CHECK(hit.modifier == modifier_of(6, kOpaque));
    CHECK(hit.t == 4);
    CHECK(hit.cos_out == 1);
    CHECK(hit.position == Vec3{0.3, 0.4, 1});
    CHECK_FALSE(geometry.intersect_surface(low, {{3, 3, 3}, {0, 0, -1}}).exists());
}

TEST_CASE("bounds hold surfaces as they are and placed models by their cubes") {
    TestModels scene;
    scene.models.resize(2);
    scene.add(surface(PrimitiveType::sphere, {1, 2, 3, 0.5}, 0, kOpaque));
    CHECK(scene.build().bounds().lower == Vec3{0.5, 1.5, 2.5});
    CHECK(scene.build().bounds().upper == Vec3{1.5, 2.5, 3.5});
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kOpaque), 1);
    scene.place(1, 0, similarity(2, false, {0, 0, 1}, 0, {0, 0, 0}));
    const Bounds bounds = scene.build().bounds();
    CHECK(bounds.lower.x == rounded(-2e-5, 2));
    CHECK(bounds.lower.z == rounded(-1 - 2e-5));  // a cube: as high as it is wide
    CHECK(bounds.upper == Vec3{2 + 2e-5, 2.5, 3.5});
    scene.models[1].geometry.cube = Bounds{{0, 0, 0}, {4, 4, 4}};
    CHECK(scene.build().bounds().upper == Vec3{8, 8, 8});
    CHECK(TestModels{}.build().bounds().empty());
}

TEST_CASE("nothing hostile hangs, crashes or lies") {
    const TestModels empty;
    CHECK_FALSE(empty.build().intersect(kDown).exists());

    TestModels scene;
    scene.add(surface(PrimitiveType::ring, {0, 0, -1, 0, 0, 1, 0, 1e9}, 0, kOpaque));
    scene.add(surface(PrimitiveType::sphere, {1e25, 0, 0, 1}, 0, kOpaque));
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kOpaque));
    const BuiltGeometry geometry = scene.build();
    CHECK(geometry.intersect(kDown).surface == SurfaceId{2});
    CHECK(geometry.intersect({{1e8, 1e8, 5}, {0, 0, -1}}).surface == SurfaceId{0});
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kInf = std::numeric_limits<double>::infinity();
    for (const double bad : {kNan, kInf, -kInf}) {
        CHECK_FALSE(geometry.intersect({{bad, 0, 5}, {0, 0, -1}}).exists());
        CHECK_FALSE(geometry.intersect({{0.3, 0.4, 5}, {0, bad, -1}}).exists());
        CHECK(geometry.visibility({{0, bad, 5}, {0, 0, -1}}, kNoSurface) == Visibility::clear);
    }
    CHECK_FALSE(geometry.intersect({{0.3, 0.4, 5}, {0, 0, 0}}).exists());
    CHECK_FALSE(geometry.intersect({{0.3, 0.4, 5}, {0, 0, -1}, kNan}).exists());
    CHECK_FALSE(geometry.intersect({{0.3, 0.4, 5}, {0, 0, -1}, -1}).exists());
    CHECK(geometry.intersect({{0.3, 0.4, 5}, {0, 0, -1}, kInf}).t == 5);
}

TEST_CASE("placements that multiply beyond measure are refused, those of nothing are not counted") {
    TestModels scene;
    scene.models.resize(31);
    for (std::size_t m = 0; m < 30; ++m) {
        scene.place(m + 1, m, Transform{});
        scene.place(m + 1, m, Transform{});
    }
    CHECK(scene.build().instance_count() == 0);
    scene.add(surface(PrimitiveType::polygon, square(0), 0, kOpaque), 30);
    CHECK_THROWS_WITH_AS(static_cast<void>(scene.build()),
                         doctest::Contains("multiply to more than 4194304 copies"), InputError);

    TestModels nested;
    nested.models.resize(2);
    nested.add(surface(PrimitiveType::polygon, square(0), 0, kOpaque), 1);
    nested.place(1, 0, similarity(1e-200, false, {0, 0, 1}, 0, {0, 0, 0}));
    nested.models[0].surfaces.back().where = {"room.rad", 3};
    nested.models[0].geometry.placements[0].transform.inverse.row[0].x =
        std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(static_cast<void>(nested.build()),
                         doctest::Contains("room.rad:3: bad transform"), InputError);
}

TEST_CASE("a scene far from the origin is as exact as one at the origin") {
    const Vec3 away{500000, 4000000, 100};
    TestModels scene;
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = away + random.in_box(5);
        scene.add(
            surface(PrimitiveType::sphere, {p.x, p.y, p.z, random.uniform(0.01, 0.3)}, i, kOpaque));
    }
    const BuiltGeometry geometry = scene.build();
    BruteForce brute(scene);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const RaySegment ray{away + random.in_box(5), random.direction()};
        const Hit hit = geometry.intersect(ray);
        const BruteForce::Best expected = brute.nearest(ray);
        REQUIRE(same_bits(hit.t, expected.t));
        REQUIRE(hit.surface == expected.surface);
        hits += hit.exists() ? 1 : 0;
    }
    CHECK(hits > 100);
}

TEST_CASE("memory is accounted for") {
    TestModels small, large;
    for (int i = 0; i < 10; ++i)
        small.add(surface(PrimitiveType::sphere, {1.0 * i, 0, 0, 0.5}, 0, kOpaque));
    for (int i = 0; i < 5000; ++i)
        large.add(surface(PrimitiveType::sphere, {1.0 * i, 0, 0, 0.5}, 0, kOpaque));
    CHECK(large.build().memory().tree > small.build().memory().tree + std::size_t{80000});
}
