// Models inside models: which instance is which path, how deep, and what boxes hold them.
#include <doctest/doctest.h>
#include <pthread.h>

#include <algorithm>
#include <array>

#include "core/geometry/bounds.h"
#include "core/geometry/instances.h"
#include "tests/core/geometry/geometry_scenes.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Every path below a model, one after the other, as instances are numbered.
void walk_paths(const GeometryInput& input, const PlacedModel& around, InstanceId instance,
                std::vector<PlacedModel>& paths) {
    for (const Placement& placement : input.models[around.model].placements) {
        if (placement.model == 3) continue;  // holds nothing
        PlacedModel placed = around;
        placed.model = placement.model;
        placed.to_world = placement.transform * around.to_world;
        if (placement.overrides && placed.override_surface == kNoSurface) {
            placed.override_surface = placement.surface;
            placed.override_instance = instance;
        }
        paths.push_back(placed);
        walk_paths(input, placed, InstanceId{static_cast<std::int32_t>(paths.size()) - 1}, paths);
    }
}

/// A chain of models, each placed in the one before it, `depth` placements long, with a square at
/// its end, a metre up for each.
TestModels chain(std::size_t depth) {
    TestModels scene;
    scene.models.resize(depth + 1);
    const std::vector<double> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    scene.add(surface(PrimitiveType::polygon, square, 0, kOpaque), depth);
    for (std::size_t i = 0; i < depth; ++i)
        scene.place(i + 1, i, similarity(1, false, {0, 0, 1}, 0, {0, 0, 1}));
    return scene;
}

/// Runs something with two megabytes of stack, half of what threads of oneTBB have.
template <class Work>
void with_small_stack(Work& work) {
    pthread_attr_t attributes;
    REQUIRE(pthread_attr_init(&attributes) == 0);
    REQUIRE(pthread_attr_setstacksize(&attributes, std::size_t{2} << 20) == 0);
    pthread_t thread{};
    const auto run = [](void* what) -> void* {
        (*static_cast<Work*>(what))();
        return nullptr;
    };
    REQUIRE(pthread_create(&thread, &attributes, run, &work) == 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

}  // namespace

TEST_CASE("instances: a frame is the path that a walk through all placements comes to") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        TestModels scene;
        scene.models.resize(7);
        for (const std::size_t model : {1, 2, 4, 5, 6}) scene.add(random_surface(random), model);
        for (std::size_t in = 0; in < 6; ++in) {
            const int count = in == 3 ? 0 : 1 + random.below(6);
            for (int i = 0; i < count; ++i) {
                const std::size_t model =
                    in + 1 + static_cast<std::size_t>(random.below(6 - static_cast<int>(in)));
                scene.place(model, in,
                            similarity(random.uniform(0.5, 2), random.below(2) == 0,
                                       random.direction(), random.uniform(0, 6), random.in_box(9)),
                            random.below(4) == 0);
            }
        }
        const TestModels::Tables tables(scene);
        const GeometryInput& input = tables.input;
        std::vector<PlacedModel> paths;
        walk_paths(input, {}, kWorld, paths);
        const InstancePaths instances(input);
        REQUIRE(instances.count() == paths.size());
        CHECK(instances.at(kWorld).to_world.is_identity());
        for (std::size_t i = 0; i < paths.size(); ++i) {
            const PlacedModel placed = instances.at(InstanceId{static_cast<std::int32_t>(i)});
            CHECK(placed.model == paths[i].model);
            CHECK(placed.to_world.forward == paths[i].to_world.forward);
            CHECK(placed.to_world.inverse == paths[i].to_world.inverse);
            CHECK(placed.to_world.scale == paths[i].to_world.scale);
            CHECK(placed.override_surface == paths[i].override_surface);
            CHECK(placed.override_instance == paths[i].override_instance);
            const ModelUse& use = instances.use(placed.model);
            CHECK(use.least_size <= placed.to_world.size());
            CHECK(use.most_size >= placed.to_world.size());
        }
    }
}

TEST_CASE("instances: models 32 deep are searched with little stack, deeper ones are refused") {
    const TestModels deep = chain(32);
    const BuiltGeometry geometry = deep.build();
    std::array<Hit, 16> hits;
    Visibility seen = Visibility::clear;
    auto search = [&] {
        std::array<RaySegment, 16> rays;
        for (RaySegment& ray : rays) ray = {{0.3, 0.4, 40}, {0, 0, -1}};
        geometry.intersect(rays, hits);
        seen = geometry.visibility(rays[0], kNoSurface);
    };
    with_small_stack(search);
    for (const Hit& hit : hits) {
        CHECK(hit.t == 8);
        CHECK(hit.instance == InstanceId{31});
    }
    CHECK(seen == Visibility::blocked);

    CHECK_THROWS_WITH_AS(static_cast<void>(chain(33).build()), "nested too deeply", InputError);
    TestModels again = chain(32);  // a second, longer way to models that were seen already
    again.models.resize(34);
    again.place(1, 33, Transform{});
    again.place(33, 0, Transform{});
    CHECK_THROWS_WITH_AS(static_cast<void>(again.build()), "nested too deeply", InputError);
}

TEST_CASE("an outline holds all its boxes, and what is slanted more tightly than one box does") {
    CHECK(outline_of({}).empty());
    CHECK(outline_of(std::vector<Bounds>(3)).empty());
    std::vector<Bounds> boxes;
    for (int i = 0; i < 100; ++i) {
        const double x = 0.1 * i;
        boxes.push_back({{x, x, 0}, {x + 0.2, x + 0.2, 1}});
    }
    const std::vector<Bounds> outline = outline_of(boxes);
    CHECK(outline.size() <= 64);
    double area = 0;
    for (const Bounds& part : outline)
        area += (part.upper.x - part.lower.x) * (part.upper.y - part.lower.y);
    CHECK(area < 0.4 * 10.1 * 10.1);
    for (const Bounds& box : boxes) {
        const bool held = std::any_of(outline.begin(), outline.end(), [&](const Bounds& part) {
            return contains(part, box.lower) && contains(part, box.upper);
        });
        CHECK(held);
    }
    const std::vector<Bounds> point{{{1, 2, 3}, {1, 2, 3}}};
    REQUIRE(outline_of(point).size() == 1);
    CHECK(outline_of(point)[0].upper == Vec3{1, 2, 3});
}
