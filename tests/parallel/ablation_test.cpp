// What makes light faster changes no bit of it.
#include "core/ablation.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "parallel/fibers/context_fibers.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

using test::TestScene;

/// Mirrors, glass and mixtures, and many lights, some with functions as patterns.
std::string room() {
    std::string text =
        "void plastic floor_paint 0 0 5 .6 .5 .4 .05 .1\n"
        "floor_paint polygon floor 0 0 12 -5 -5 0 5 -5 0 5 5 0 -5 5 0\n"
        "void mirror silver 0 0 3 .8 .8 .8\nsilver ring glass1 0 0 8 2 0 1 -1 0 .2 0 1\n"
        "void glass pane 0 0 3 .8 .9 .7\n"
        "pane polygon window 0 0 12 -1 -1 .5 0 -1 .5 0 1 .9 -1 1 .9\n"
        "void metal brass 0 0 5 .7 .6 .2 .9 .0\nbrass sphere ball 0 0 4 1 1.5 .5 .5\n"
        "void plastic chalk 0 0 5 .7 .7 .7 0 0\nvoid mixfunc mixed 4 brass chalk .5 . 0 0\n"
        "mixed sphere ball2 0 0 4 -1 -2 .4 .4\n"
        "void brightfunc sky 2 if(Dz-.2,exp(Dz),1-Dx*Dx) . 0 0\nsky light day 0 0 3 2 3 4\n";
    for (int i = 0; i < 8; ++i) {
        const std::string x = std::to_string(i - 4.0), right = std::to_string(i - 3.2);
        text += "day polygon opening" + std::to_string(i) + " 0 0 12 " + x + " 5 1 " + x + " 5 4 " +
                right + " 5 4 " + right + " 5 1\n";
    }
    for (int i = 0; i < 20; ++i) {
        const std::string n = std::to_string(i);
        text += "void light l" + n + " 0 0 3 " + n + " 9 5\nl" + n + " sphere s" + n + " 0 0 4 " +
                std::to_string(i % 5 - 2.5) + " " + std::to_string(i / 5 - 2) + " 4 .05\n";
    }
    return text;
}

RenderOptions usual(int bounces, const Ablation& ablation) {
    RenderOptions options = TestScene::exact();
    options.shadow_threshold = 0.05;
    options.source_subdivision = 0.2;
    options.source_jitter = 0.6;
    options.ambient_bounces = bounces;
    options.ambient_divisions = 64;
    options.ambient_super_samples = 16;
    options.ablation = ablation;
    return options;
}

struct Picture {
    std::vector<std::uint32_t> bits;
    std::size_t values = 0;  ///< in the cache
    RayCounters rays;
};

/// A small picture, in packets, by one thread.
Picture picture(int bounces, const Ablation& ablation, MakeFibers make_fibers, int side) {
    TestScene scene(room(), usual(bounces, ablation));
    SerialCache cache(ambient_limits({-6, -6, -1}, 12, 0.2, 32));
    scene.tracer.use_ambient_cache(&cache);
    scene.context.batches.make_fibers = make_fibers;
    Picture result;
    for (int y = 0; y < side; ++y) {
        std::vector<Ray> rays;
        std::vector<Hit> hits;
        for (int x = 0; x < 4 * side; ++x) {
            const auto random = RandomStream::of_pixel(5, static_cast<std::uint32_t>(x),
                                                       static_cast<std::uint32_t>(y), 0);
            rays.push_back(scene.tracer.primary(
                {0, 0, 3.5}, {x / (4.0 * side) - 0.5, 1.0 * y / side - 0.5, -0.6}, 0, random));
            hits.push_back(scene.scene.geometry().intersect(rays.back().segment()));
        }
        scene.tracer.shade_hits(rays, hits, scene.context);
        for (const Ray& ray : rays) {
            for (std::size_t c = 0; c < 3; ++c)
                result.bits.push_back(std::bit_cast<std::uint32_t>(ray.value[c]));
        }
    }
    result.values = cache.size();
    result.rays = scene.context.counters.rays;
    return result;
}

/// Fewer at a time than the tracer asks for.
std::unique_ptr<Fibers> make_five_fibers(std::size_t /*count*/) {
    return make_context_fibers(5);
}

}  // namespace

TEST_CASE("batches and lanes change no bit of a picture, nor what is traced for it") {
    const Picture all = picture(0, {}, make_context_fibers, 12);
    CHECK(all.rays.shadow > 1000);
    for (const Ablation& less : {Ablation{.batches = false}, Ablation{.function_lanes = false},
                                 Ablation{.sample_lanes = false}}) {
        const Picture other = picture(0, less, make_context_fibers, 12);
        CHECK(other.bits == all.bits);
        CHECK(other.rays.shadow == all.rays.shadow);
    }
}

TEST_CASE("how many rays wait decides nothing of a picture with a cache that it fills itself") {
    for (const int bounces : {1, 2}) {
        CAPTURE(bounces);
        const Picture all = picture(bounces, {}, make_context_fibers, 6);
        CHECK(all.values > 10);
        const Picture alone = picture(bounces, {.batches = false}, make_context_fibers, 6),
                      few = picture(bounces, {}, make_five_fibers, 6);
        for (const Picture* other : {&alone, &few}) {
            CHECK(other->bits == all.bits);
            CHECK(other->values == all.values);
            CHECK(other->rays.ambient == all.rays.ambient);
        }
    }
}

}  // namespace lightwalk
