// What makes the search faster changes no bit of what rays meet.
#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "tests/core/geometry/geometry_scenes.h"

namespace lightwalk::test {
namespace {

/// Long slanted branches, and so many specks that the model's tree ends in leaves; beside a small
/// model, whose branches are divided.
TestModels branches_and_specks() {
    Random random(11);
    TestModels scene;
    scene.models.resize(2);
    const auto branch = [&](std::size_t model) {
        const Vec3 p = random.in_box(3), q = random.in_box(3);
        scene.add(surface(PrimitiveType::cone,
                          {p.x, p.y, p.z, q.x, q.y, q.z, random.uniform(0.005, 0.02), 0.03},
                          random.below(5), kOpaque),
                  model);
    };
    for (int i = 0; i < 140'000; ++i) {
        const Vec3 p = random.in_box(3);
        scene.add(surface(PrimitiveType::sphere, {p.x, p.y, p.z, random.uniform(0.01, 0.03)},
                          random.below(5), i % 7 == 0 ? kGlass : kOpaque),
                  1);
    }
    for (int i = 0; i < 200; ++i) branch(0);
    scene.place(1, 0, similarity(0.5, true, {1, 2, 3}, 1, {4, 0, 0}));
    return scene;
}

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

void require_same(const Hit& a, const Hit& b) {
    REQUIRE(a.surface == b.surface);
    REQUIRE(bits(a.t) == bits(b.t));
    for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(bits(a.position[k]) == bits(b.position[k]));
        REQUIRE(bits(a.normal[k]) == bits(b.normal[k]));
    }
}

/// Answers to rays, coherent ones and others.
struct Answers {
    std::vector<Hit> hits;
    std::vector<Visibility> visibility;
};

Answers ask(const TestModels& scene, const Ablation& ablation) {
    TestModels::Tables tables(scene);
    tables.input.ablation = ablation;
    const Geometry geometry(tables.input);
    Random random(3);
    std::vector<RaySegment> rays;
    std::vector<ShadowQuery> queries;
    for (int i = 0; i < 600; ++i) {
        const Vec3 from = random.in_box(6);
        for (int k = 0; k < 5; ++k) {
            rays.push_back({from, normalize(random.in_box(3) - from), random.uniform(1, 12)});
            queries.push_back({rays.back(), kNoSurface, nullptr});
        }
    }
    Answers answers{std::vector<Hit>(rays.size()), std::vector<Visibility>(rays.size())};
    geometry.intersect(rays, answers.hits);
    geometry.visibility(queries, answers.visibility);
    for (std::size_t i = 0; i < rays.size(); i += 7)
        require_same(geometry.intersect(rays[i]), answers.hits[i]);
    return answers;
}

}  // namespace

TEST_CASE("leaves, slices and packets change no bit of what rays meet") {
    const TestModels scene = branches_and_specks();
    const Answers all = ask(scene, {});
    int hits = 0, blocked = 0;
    for (const Hit& hit : all.hits) hits += hit.exists() ? 1 : 0;
    for (const Visibility v : all.visibility) blocked += v == Visibility::blocked ? 1 : 0;
    CHECK(hits > 500);
    CHECK(hits < 2900);
    CHECK(blocked > 500);
    for (const Ablation& less :
         {Ablation{.leaves = false}, Ablation{.slices = false}, Ablation{.packets = false}}) {
        const Answers other = ask(scene, less);
        CHECK(other.visibility == all.visibility);
        for (std::size_t i = 0; i < all.hits.size(); ++i) require_same(all.hits[i], other.hits[i]);
    }
}

}  // namespace lightwalk::test
