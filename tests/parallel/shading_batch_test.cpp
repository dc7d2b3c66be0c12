// Rays side by side: they bring back what they bring back alone.
#include "core/batch/shading_batch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/light/find_light_groups.h"
#include "parallel/fibers/context_fibers.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

using test::MemoryResources;
using test::TestScene;

constexpr std::size_t kRays = 64, kSome = kRays + 9;

const std::string kLamp = "void light lamp 0 0 3 9 8 7\nlamp sphere bulb 0 0 4 0 0 4 .2\n";

/// What a batch of rays that ask for direct light in vain is told and tells.
struct Asking {
    Asking() : scene(kLamp) {}
    void run(std::size_t count, FunctionRef<void(std::size_t)> body) {
        const auto calculate = [&](std::span<const DirectRequest> requests) {
            CHECK(scene.context.batches.current == nullptr);
            served.push_back(requests.size());
            for (const DirectRequest& request : requests) request.ray->value += Rgb{1, 1, 1};
        };
        batch.run(count, body, calculate, scene.context);
        CHECK(scene.context.batches.current == nullptr);
        CHECK(scene.context.path.nesting.rays == 0);
    }
    void ask(Ray& ray) {
        const auto none = one_by_one([](const Vec3&, double) { return Rgb{}; });
        batch.wait({&ray, none}, scene.context);
    }
    TestScene scene;
    ShadingBatch batch{make_context_fibers(kRays)};
    std::vector<std::size_t> served;
};

/// A room with all that makes rays wait: mirrors, glass, gloss, mixtures, patterns, many lights.
std::string batch_room() {
    std::string text =
        "void brightfunc grain 2 if(noise3(Px,Py,Pz),.9,.4) . 0 0\n"
        "grain plastic floor_paint 0 0 5 .6 .5 .4 .05 .1\n"
        "floor_paint polygon floor 0 0 12 -5 -5 0 5 -5 0 5 5 0 -5 5 0\n"
        "void mirror silver 0 0 3 .8 .8 .8\nsilver ring glass1 0 0 8 2 0 1 -1 0 .2 0 1\n"
        "void glass pane 0 0 3 .8 .9 .7\npane polygon window 0 0 12 -1 -1 .5 0 -1 .5 0 1 .9 -1 1 "
        ".9\n"
        "void metal brass 0 0 5 .7 .6 .2 .9 .0\nbrass sphere ball 0 0 4 1 1.5 .5 .5\n"
        "void trans cloth 0 0 7 .5 .5 .5 .05 .1 .5 .3\ncloth ring sail 0 0 8 -2 1 1 0 1 1 0 .8\n"
        "void mixfunc mixed 4 brass cloth abs(sin(9*Px)) . 0 0\n"
        "mixed sphere ball2 0 0 4 -1 -2 .4 .4\n"
        "void brightfunc sky 2 if(Dz-.2,exp(Dz),1-Dx*Dx) . 0 0\n"
        "sky light day 0 0 3 2 3 4\n"
        "day polygon opening 0 0 12 -3 5 1 -3 5 4 3 5 4 3 5 1\n";
    for (int i = 0; i < 30; ++i) {
        const std::string n = std::to_string(i);
        text += "void light l" + n + " 0 0 3 " + n + " 9 5\nl" + n + " sphere s" + n + " 0 0 4 " +
                std::to_string(i % 6 - 2.5) + " " + std::to_string(i / 6 - 2) + " 4 .05\n";
    }
    return text;
}

RenderOptions usual() {
    RenderOptions options = TestScene::exact();
    options.shadow_threshold = 0.05;
    options.source_subdivision = 0.2;
    options.source_jitter = 0.6;
    options.specular_samples = 1;
    return options;
}

std::vector<Ray> looking_down(const TestScene& scene, int side) {
    std::vector<Ray> rays;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            rays.push_back(scene.tracer.primary(
                {0, 0, 3.5}, {(x - side / 2.0) / side, (y - side / 2.0) / side, -0.6}, 0,
                RandomStream::of_pixel(5, static_cast<std::uint32_t>(x),
                                       static_cast<std::uint32_t>(y), 0)));
        }
    }
    return rays;
}

bool same_bits(const Rgb& a, const Rgb& b) {
    for (std::size_t c = 0; c < 3; ++c) {
        if (std::bit_cast<std::uint32_t>(a[c]) != std::bit_cast<std::uint32_t>(b[c])) return false;
    }
    return true;
}

std::vector<Hit> hits_of(const TestScene& scene, const std::vector<Ray>& rays) {
    std::vector<Hit> hits;
    for (const Ray& ray : rays)
        hits.push_back(scene.scene.geometry().intersect({ray.origin, ray.direction, kHuge}));
    return hits;
}

}  // namespace

TEST_CASE("shading batches: all that wait are calculated together, as often as they ask") {
    Asking asking;
    std::vector<Ray> rays(kSome);
    asking.run(kSome, [&](std::size_t i) {
        for (std::size_t k = 0; k < i % 3; ++k) asking.ask(rays[i]);
    });
    for (std::size_t i = 0; i < kSome; ++i) CHECK(rays[i].value.r == static_cast<float>(i % 3));
    REQUIRE(asking.served.size() == 4);  // two full rounds, and two of what is left
    CHECK(asking.served[0] == 42);       // 1, 2, 4, 5, ... 62
    CHECK(asking.served[1] == 21);
}

TEST_CASE("shading batches: the first ray's exception goes on, when all have ended") {
    Asking asking;
    std::vector<Ray> rays(8);
    int ended = 0;
    const auto body = [&](std::size_t i) {
        asking.ask(rays[i]);
        if (i == 5) throw std::string("five");
        asking.ask(rays[i]);
        if (i == 3) throw std::string("three");
        ++ended;
    };
    CHECK_THROWS_AS(asking.run(8, body), std::string);
    CHECK(ended == 6);
    try {
        asking.run(8, body);
    } catch (const std::string& first) {
        CHECK(first == "three");
    }
}

TEST_CASE("shading batches: what the calculation throws reaches those that wait for it") {
    Asking asking;
    std::vector<Ray> rays(4);
    int told = 0;
    const auto fails = [](std::span<const DirectRequest>) { throw std::string("dark"); };
    const auto body = [&](std::size_t i) {
        try {
            asking.ask(rays[i]);
        } catch (const std::string&) {
            ++told;
        }
    };
    asking.batch.run(4, body, fails, asking.scene.context);
    CHECK(told == 4);
}

TEST_CASE("shading batches: work on the outer stack may not wait, and may throw") {
    Asking asking;
    int done = 0;
    asking.run(5, [&](std::size_t i) {
        TraceContext& context = asking.scene.context;
        context.path.nesting.rays += static_cast<int>(i);
        const auto work = [&] {
            CHECK(context.batches.current == nullptr);
            CHECK(context.path.nesting.rays == static_cast<int>(i));
            if (i == 2) throw 2;
            ++done;
        };
        try {
            asking.batch.outside(work, context);
        } catch (int thrown) {
            done += 10 * thrown;
        }
        CHECK(context.batches.current == &asking.batch);
        CHECK(context.path.nesting.rays == static_cast<int>(i));
    });
    CHECK(done == 24);
}

TEST_CASE("shading batches: rays that go side by side bring back the bits that they bring alone") {
    for (const bool every_shadow : {false, true}) {
        CAPTURE(every_shadow);
        RenderOptions options = usual();
        if (every_shadow) options.shadow_threshold = 0;
        TestScene scene(batch_room(), options);
        scene.context.batches.make_fibers = make_context_fibers;
        std::vector<Ray> together = looking_down(scene, 20), alone = together;
        const std::vector<Hit> hits = hits_of(scene, together);
        for (std::size_t i = 0; i < alone.size(); ++i)
            scene.tracer.shade_hit(alone[i], hits[i], scene.context);
        const std::uint64_t shadow_rays = scene.context.counters.rays.shadow;
        scene.tracer.shade_hits(together, hits, scene.context);
        CHECK(scene.context.counters.rays.shadow == 2 * shadow_rays);
        CHECK(scene.context.counters.rays.specular > 100);
        int lit = 0;
        for (std::size_t i = 0; i < alone.size(); ++i) {
            CAPTURE(i);
            REQUIRE(same_bits(together[i].value, alone[i].value));
            CHECK(together[i].effective_distance() == alone[i].effective_distance());
            lit += max_component(alone[i].value) > 0 ? 1 : 0;
        }
        CHECK(lit > 300);
    }
}

TEST_CASE("shading batches: the same with so many lights that a batch is calculated in parts") {
    std::string text = batch_room();
    for (int i = 0; i < 1200; ++i) {
        const std::string n = std::to_string(i);
        text += "l" + std::to_string(i % 30) + " sphere many" + n + " 0 0 4 " +
                std::to_string(0.2 * (i % 40) - 4) + " " + std::to_string(0.2 * (i / 40) - 3) +
                " 4.5 .01\n";
    }
    TestScene scene(text, usual());
    scene.context.batches.make_fibers = make_context_fibers;
    std::vector<Ray> together = looking_down(scene, 6), alone = together;
    const std::vector<Hit> hits = hits_of(scene, together);
    for (std::size_t i = 0; i < alone.size(); ++i)
        scene.tracer.shade_hit(alone[i], hits[i], scene.context);
    scene.tracer.shade_hits(together, hits, scene.context);
    for (std::size_t i = 0; i < alone.size(); ++i)
        CHECK(same_bits(together[i].value, alone[i].value));
}

TEST_CASE("shading batches: ambient rays go side by side, too, within those that ask") {
    RenderOptions options = usual();
    options.ambient_bounces = 2;
    options.ambient_divisions = 64;
    options.ambient_accuracy = 0;  // every value is computed anew
    TestScene scene(batch_room(), options);
    scene.context.batches.make_fibers = make_context_fibers;
    std::vector<Ray> together = looking_down(scene, 3), alone = together;
    const std::vector<Hit> hits = hits_of(scene, together);
    for (std::size_t i = 0; i < alone.size(); ++i)
        scene.tracer.shade_hit(alone[i], hits[i], scene.context);
    const std::size_t of_ambient_rays = scene.context.batches.all.size();
    CHECK(of_ambient_rays >= 1);
    scene.tracer.shade_hits(together, hits, scene.context);
    CHECK(scene.context.batches.all.size() == of_ambient_rays + 1);
    CHECK(scene.context.batches.open == 0);
    for (std::size_t i = 0; i < alone.size(); ++i)
        CHECK(same_bits(together[i].value, alone[i].value));
}

TEST_CASE(
    "shading batches: of each ray that goes with others it is known what light groups bring") {
    RenderOptions options = usual();
    int side = 20;
    SUBCASE("direct light, some of it guessed") {}
    SUBCASE("ambient rays side by side within those that ask") {
        side = 3;
        options.ambient_bounces = 2;
        options.ambient_divisions = 64;
        options.ambient_accuracy = 0;
    }
    TestScene scene(batch_room(), options);
    const auto groups = std::make_shared<const LightGroups>(find_light_groups(
        scene.scene, options, {{"even", {"l*[02468]"}}, {"odd", {"l*"}}, {"day", {"day"}}}));
    GroupSums sums(groups);
    scene.context.contributions = scene.context.groups = &sums;
    std::vector<Ray> together = looking_down(scene, side), alone = together;
    const std::vector<Hit> hits = hits_of(scene, together);
    const auto told_of = [&](std::vector<Ray>& rays) {
        std::vector<std::vector<Rgb>> told(rays.size());
        scene.tracer.shade_hits(rays, hits, scene.context, [&](std::size_t i) {
            told[i].assign(sums.sums().begin(), sums.sums().end());
            told[i].insert(told[i].end(), sums.reflected().begin(), sums.reflected().end());
        });
        return told;
    };
    const std::vector<std::vector<Rgb>> expected = told_of(alone);
    scene.context.batches.make_fibers = make_context_fibers;
    const std::vector<std::vector<Rgb>> told = told_of(together);
    CHECK(!scene.context.batches.all.empty());
    CHECK(sums.root() == nullptr);
    int with_all = 0;
    for (std::size_t i = 0; i < told.size(); ++i) {
        CAPTURE(i);
        REQUIRE(told[i].size() == expected[i].size());
        for (std::size_t g = 0; g < told[i].size(); ++g)
            CHECK(same_bits(told[i][g], expected[i][g]));
        Rgb left = together[i].value;
        for (std::size_t g = 0; g < groups->size(); ++g) left -= told[i][g];
        const float most = std::max(max_component(left), -min_component(left));
        CHECK(most <= 1e-5f * max_component(together[i].value));
        if (max_component(told[i][0]) > 0 && max_component(told[i][1]) > 0) ++with_all;
    }
    CHECK(with_all > static_cast<int>(told.size()) / 2);
    for (const Rgb& value : sums.sums()) CHECK(value == Rgb{});  // nothing went to nobody
}

TEST_CASE("shading batches: rays and mixtures may be nested as deep as elsewhere") {
    // A stack of surfaces without material, each of which sends the ray on.
    std::string text = kLamp +
                       "void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey ring end 0 0 8 0 0 -9999 0 "
                       "0 1 0 9\n";
    for (int i = 0; i < Tracer::kMaxDepth - 1; ++i) {
        text += "void ring r" + std::to_string(i) + " 0 0 8 0 0 -" + std::to_string(1 + i) +
                " 0 0 1 0 9\n";
    }
    std::string modifier = "grey";
    for (int i = 0; i < 2000; ++i) {
        const std::string name = "m" + std::to_string(i);
        text += "void mixfunc " + name + " 4 " + modifier + " void .999 . 0 0\n";
        modifier = name;
    }
    text += modifier + " ring mixed 0 0 8 20 0 0 0 0 1 0 9\n";
    TestScene scene(text);
    scene.context.batches.make_fibers = make_context_fibers;
    std::vector<Ray> together;
    for (const double x : {0.0, 0.1, 20.0, 20.1})
        together.push_back(scene.tracer.primary({x, 0, 1}, {0, 0, -1}, 0, RandomStream(1)));
    std::vector<Ray> alone = together;
    const std::vector<Hit> hits = hits_of(scene, together);
    for (std::size_t i = 0; i < alone.size(); ++i)
        scene.tracer.shade_hit(alone[i], hits[i], scene.context);
    scene.tracer.shade_hits(together, hits, scene.context);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(max_component(alone[i].value) > 0);
        CHECK(same_bits(together[i].value, alone[i].value));
    }
}

}  // namespace lightwalk
