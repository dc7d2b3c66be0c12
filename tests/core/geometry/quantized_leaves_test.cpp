// Quantized leaves: each BVH primitive is in one, no ray that meets its box
// is told that it does not, and a model of leaves is hit where its surfaces are.
#include "core/geometry/quantized_leaves.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "core/geometry/bounds.h"
#include "core/geometry/embree_leaves.h"
#include "tests/core/geometry/geometry_scenes.h"

namespace lightwalk {
namespace {

struct ReleaseDevice {
    void operator()(RTCDeviceTy* device) const noexcept { rtcReleaseDevice(device); }
};

/// A model's BVH primitives, and the quantized leaves made of them.
struct Leaves {
    explicit Leaves(const test::TestModels& scene)
        : tables(scene), model(tables.surfaces, tables.input.models[0], SerialTaskRunner()) {
        space.center = {1, -2, 3};
        space.margin = 1e-5;
        bvh_primitives = divide_primitives(model, SerialTaskRunner());
        const std::unique_ptr<RTCDeviceTy, ReleaseDevice> device(rtcNewDevice(""));
        leaves =
            make_quantized_leaves(bvh_primitives, model, space, device.get(), SerialTaskRunner());
    }
    test::TestModels::Tables tables;
    ModelPrimitives model;
    SearchSpace space;
    BvhPrimitives bvh_primitives;
    std::vector<QuantizedLeaf> leaves;
};

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

test::TestModels random_scene(int count) {
    test::Random random(11);
    test::TestModels scene;
    for (int i = 0; i < count; ++i) scene.add(test::random_surface(random));
    return scene;
}

/// A small surface of any kind.
test::TestSurface speck(test::Random& random, int i) {
    const Vec3 p = random.in_box(5), q = p + random.in_box(0.06), n = random.direction();
    const Vec3 a = random.in_box(0.05), b = random.in_box(0.05);
    using enum PrimitiveType;
    switch (i % 4) {
        case 0:
            return test::surface(sphere, {p.x, p.y, p.z, 0.02}, 0, test::kOpaque);
        case 1:
            return test::surface(cylinder, {p.x, p.y, p.z, q.x, q.y, q.z, 0.01}, 0, test::kOpaque);
        case 2:
            return test::surface(ring, {p.x, p.y, p.z, n.x, n.y, n.z, 0, 0.03}, 0, test::kOpaque);
        default:
            return test::surface(
                polygon,
                {p.x, p.y, p.z, p.x + a.x, p.y + a.y, p.z + a.z, p.x + b.x, p.y + b.y, p.z + b.z},
                0, test::kOpaque);
    }
}

}  // namespace

TEST_CASE("each primitive is in one quantized leaf, and leaves are well filled") {
    const Leaves scene(random_scene(3000));
    std::vector<int> times(scene.model.size());
    std::size_t all = 0;
    for (const QuantizedLeaf& leaf : scene.leaves) {
        bool ended = false;
        for (const PrimitiveRange bvh_primitive : leaf.bvh_primitives) {
            REQUIRE_FALSE((ended && !bvh_primitive.is_none()));  // those that there are come first
            ended = bvh_primitive.is_none();
            if (ended) continue;
            ++all;
            for (std::uint32_t i = bvh_primitive.first(); i < bvh_primitive.end(); ++i) ++times[i];
        }
    }
    CHECK(all == scene.bvh_primitives.size());
    std::vector<int> wanted(scene.model.size());
    for (std::size_t i = 0; i < scene.bvh_primitives.size(); ++i)
        for (std::uint32_t k = 0; k < scene.bvh_primitives.count(i); ++k)
            ++wanted[scene.bvh_primitives.primitive(i) + k];
    CHECK(times == wanted);
    CHECK(scene.leaves.size() < all / 4);
}

TEST_CASE("a ray that meets a primitive of a quantized leaf meets its box, and few boxes besides") {
    const Leaves scene(random_scene(400));
    test::Random random(3);
    int hits = 0, met = 0, tested = 0;
    for (int turn = 0; turn < 3000; ++turn) {
        const Vec3 from = random.in_box(6);
        // Also along the axes, where a direction is nought.
        Vec3 direction = random.direction();
        if (turn % 5 == 0) direction = Vec3{turn % 2 == 0 ? -1.0 : 1.0, 0, 0};
        if (turn % 7 == 0) direction = normalize(Vec3{0, -direction.y, direction.z});
        const double far = turn % 3 == 0 ? 2 : 100;
        const LeafRay ray(floats(from - scene.space.center), floats(direction));
        for (const QuantizedLeaf& leaf : scene.leaves) {
            const LeafHits boxes = boxes_met(leaf, ray, static_cast<float>(far));
            for (std::size_t i = 0; i < kLeafSize; ++i) {
                const PrimitiveRange bvh_primitive = leaf.bvh_primitives[i];
                if (bvh_primitive.is_none()) break;
                const bool is_met = (boxes.met >> i & 1U) != 0;
                ++tested;
                met += is_met ? 1 : 0;
                for (std::uint32_t k = bvh_primitive.first(); k < bvh_primitive.end(); ++k) {
                    const auto hit = scene.model.intersect(k, from, direction, far);
                    if (!hit) continue;
                    ++hits;
                    // Another BVH primitive of the same primitive may hold the crossing.
                    bool is_held =
                        is_met && static_cast<double>(boxes.first[i]) <= hit->t * (1 + 1e-6) + 1e-6;
                    for (const QuantizedLeaf& other : scene.leaves) {
                        if (is_held) break;
                        const LeafHits there = boxes_met(other, ray, static_cast<float>(far));
                        for (std::size_t j = 0; j < kLeafSize; ++j)
                            is_held = is_held || ((there.met >> j & 1U) != 0 &&
                                                  !other.bvh_primitives[j].is_none() &&
                                                  other.bvh_primitives[j].first() <= k &&
                                                  k < other.bvh_primitives[j].end());
                    }
                    REQUIRE(is_held);
                }
            }
        }
    }
    CHECK(hits > 10'000);
    CHECK(met < tested / 8);
    CHECK(met < 8 * hits);
}

TEST_CASE("a quantized leaf's boxes hold its primitives' own, and are two steps larger at most") {
    test::Random random(4);
    for (int turn = 0; turn < 2000; ++turn) {
        const double size = std::pow(10, random.uniform(-4, 6));
        std::vector<Bounds> boxes(1 + static_cast<std::size_t>(random.below(8)));
        std::vector<PrimitiveRange> bvh_primitives;
        for (Bounds& box : boxes) {
            const Vec3 from = random.in_box(size), to = from + random.in_box(size / 10);
            for (const Vec3& corner : {from, to}) {
                const std::array<float, 3> p = floats(corner);
                box.extend({static_cast<double>(p[0]), static_cast<double>(p[1]),
                            static_cast<double>(p[2])});
            }
            bvh_primitives.emplace_back(static_cast<std::uint32_t>(bvh_primitives.size()), 1);
        }
        const QuantizedLeaf leaf = quantized_leaf(boxes, bvh_primitives);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            REQUIRE(leaf.bvh_primitives[i].first() == i);
            for (std::size_t k = 0; k < 3; ++k) {
                const unsigned shift = 10 * static_cast<unsigned>(k);
                const double lower = leaf.box().lower[k], step = static_cast<double>(leaf.step[k]),
                             rounding = 1e-9 * step,
                             begin = lower + step * (leaf.begin[i] >> shift & 1023U),
                             end = lower + step * (leaf.end[i] >> shift & 1023U);
                REQUIRE(begin <= boxes[i].lower[k] + rounding);
                REQUIRE(end >= boxes[i].upper[k] - rounding);
                REQUIRE(begin >= boxes[i].lower[k] - 2 * step);
                REQUIRE(end <= boxes[i].upper[k] + 2 * step);
            }
        }
    }
}

TEST_CASE("a large model, placed as well, is hit where its surfaces are") {
    test::Random random(5);
    test::TestModels scene;
    scene.models.resize(2);
    constexpr int kCount = 140'000;
    for (int i = 0; i < kCount; ++i) scene.add(speck(random, i), 1);
    const Transform turned = test::similarity(0.5, true, {1, 2, 3}, 1, {20, 0, 0});
    scene.place(1, 0, turned);
    scene.place(1, 0, Transform{});
    const test::TestModels::Tables tables(scene);
    const ModelPrimitives model(tables.surfaces, tables.input.models[1], SerialTaskRunner());
    const Geometry geometry(tables.input);
    int hits = 0;
    for (int turn = 0; turn < 24; ++turn) {
        const bool in_turned = turn % 2 == 0;
        const Vec3 origin = random.in_box(4), direction = random.direction();
        const double length = random.uniform(0.5, 3);
        double nearest = length;
        for (std::uint32_t i = 0; i < model.size(); ++i) {
            const auto hit = model.intersect(i, origin, direction, nearest);
            if (hit) nearest = hit->t;
        }
        const bool exists = nearest < length;
        hits += exists ? 1 : 0;
        const double size = in_turned ? 0.5 : 1;
        const RaySegment ray{in_turned ? turned.forward.point(origin) : origin,
                             in_turned ? normalize(turned.forward.vector(direction)) : direction,
                             length * size};
        const Hit hit = geometry.intersect(ray);
        REQUIRE(hit.exists() == exists);
        if (exists) REQUIRE(hit.t == doctest::Approx(nearest * size).epsilon(1e-6));
        REQUIRE((geometry.visibility(ray, kNoSurface) != Visibility::clear) == exists);
    }
    CHECK(hits > 6);
    CHECK(hits < 22);
}

}  // namespace lightwalk
