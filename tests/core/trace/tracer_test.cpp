// What a ray brings back when nearest hit, shading, background and medium come together, and where
// it ends.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/light/light_sources.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kGlow = "void glow lit 0 0 4 2 3 4 0\n";
const std::string kMirror = "void mirror silver 0 0 3 .5 .5 .5\n";
const std::string kGlass = "void glass pane 0 0 3 .9 .9 .9\n";

/// A rounding step of single precision, in which radiances are kept.
constexpr double kFloatStep = std::numeric_limits<float>::epsilon();

RenderOptions with(void (*change)(RenderOptions&)) {
    RenderOptions options = TestScene::exact();
    change(options);
    return options;
}

}  // namespace

TEST_CASE("tracer: a ray that meets nothing is black, at the distance that means nothing") {
    TestScene scene(kGlow + "lit sphere ball 0 0 4 0 0 5 1\n");
    const Ray ray = scene.trace({0, 0, 0}, {0, 0, -1});
    CHECK(ray.value == Rgb{});
    CHECK(ray.hit.t == kHuge);
    CHECK_FALSE(ray.hit.exists());
}

TEST_CASE("tracer: a glowing surface brings its radiance at its distance, however far") {
    TestScene scene(kGlow + "lit sphere ball 0 0 4 0 0 1000 1\n");
    const Ray ray = scene.trace({0, 0, 0}, {0, 0, 1});
    CHECK(ray.value == Rgb{2, 3, 4});
    CHECK(ray.effective_distance() == doctest::Approx(999));
}

TEST_CASE("tracer: a source at infinity is the background, but not at the aft plane") {
    TestScene scene(kGlow + "lit source sky 0 0 4 0 0 1 180\n");
    CHECK(scene.trace({0, 0, 0}, {0, 0.1, 1}).value == Rgb{2, 3, 4});
    CHECK(scene.trace({0, 0, 0}, {0, 0.1, -1}).value == Rgb{});
    Ray clipped = scene.tracer.primary({0, 0, 0}, {0, 0, 1}, 7, RandomStream(1));
    scene.tracer.trace(clipped, scene.context);
    CHECK(clipped.value == Rgb{});
}

TEST_CASE("tracer: surfaces beyond the aft clipping plane do not exist") {
    TestScene scene(kGlow + "lit sphere ball 0 0 4 0 0 5 1\n");
    for (const double limit : {3.9, 4.1}) {
        Ray ray = scene.tracer.primary({0, 0, 0}, {0, 0, 1}, limit, RandomStream(1));
        scene.tracer.trace(ray, scene.context);
        CHECK(ray.hit.exists() == (limit > 4));
    }
}

TEST_CASE("tracer: a surface without material is not there, but for the distance it hides") {
    TestScene bare(kGlow + "void ring veil 0 0 8 0 0 2 0 0 1 0 9\nlit sphere b 0 0 4 0 0 5 1\n");
    const Ray ray = bare.trace({0, 0, 0}, {0, 0, 1});
    CHECK(ray.value == Rgb{2, 3, 4});
    CHECK(ray.effective_distance() == doctest::Approx(4));
}

TEST_CASE("tracer: -lr bounds the reflections between two mirrors to that many") {
    for (const int limit : {1, 3, 6}) {
        RenderOptions options = TestScene::exact();
        options.reflection_limit = limit;
        options.weight_limit = 1e-9;
        options.redirections = 0;
        TestScene scene(kMirror +
                            "silver ring low 0 0 8 0 0 0 0 0 1 0 9\n"
                            "silver ring high 0 0 8 0 0 4 0 0 -1 0 9\n",
                        options);
        (void)scene.trace({0, 0, 1}, {0, 0, -1});
        CHECK(scene.context.counters.rays.specular == static_cast<std::uint64_t>(limit));
    }
}

TEST_CASE("tracer: -lw ends a path when what it can still bring is smaller") {
    // Each mirror keeps a half: after n reflections the weight is 2^-n.
    TestScene scene(kMirror +
                        "silver ring low 0 0 8 0 0 0 0 0 1 0 9\n"
                        "silver ring high 0 0 8 0 0 4 0 0 -1 0 9\n",
                    with([](RenderOptions& options) {
                        options.reflection_limit = 100;
                        options.weight_limit = 0.1;
                        options.redirections = 0;
                    }));
    (void)scene.trace({0, 0, 1}, {0, 0, -1});
    CHECK(scene.context.counters.rays.specular == 3);  // 1/2, 1/4, 1/8 are above a tenth
}

TEST_CASE("tracer: Russian roulette brings the same mean as tracing every path") {
    // A lamp in two mirrors, far above the weight limit that roulette plays with.
    const std::string text = kMirror + kGlow +
                             "silver ring low 0 0 8 0 0 0 0 0 1 0 9\n"
                             "silver ring high 0 0 8 0 0 4 0 0 -1 0 9\n"
                             "lit polygon tilted 0 0 12 6 -9 0 6 -9 4 6 9 4 6 9 0\n";
    const auto options = [](int limit) {
        RenderOptions all = TestScene::exact();
        all.reflection_limit = limit;
        all.weight_limit = 0.3;
        all.redirections = 0;
        return all;
    };
    RenderOptions exact = options(20);
    exact.weight_limit = 1e-9;
    const Vec3 direction{1, 0, -1.5};  // three reflections, 1/8 of the radiance arrives
    TestScene all(text, exact);
    const double expected = static_cast<double>(all.trace({0, 0, 2}, direction).value.r);
    REQUIRE(expected > 0);
    TestScene roulette(text, options(-20));
    constexpr std::uint32_t kPaths = 20000;
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < kPaths; ++i) {
        const auto value = static_cast<double>(roulette.trace({0, 0, 2}, direction, i).value.r);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kPaths;
    const double standard_error = std::sqrt((squares / kPaths - mean * mean) / kPaths);
    REQUIRE(standard_error < 0.02 * expected);
    CHECK(std::abs(mean - expected) < 4 * standard_error);
}

TEST_CASE("tracer: Russian roulette without a weight limit would never end and is refused") {
    CHECK_THROWS_AS(TestScene(kGlow, with([](RenderOptions& options) {
                                  options.reflection_limit = -5;
                                  options.weight_limit = 0;
                              })),
                    InputError);
}

TEST_CASE("tracer: nesting ends at kMaxDepth, black and in finite time") {
    // A stack of surfaces without material, each of which sends the ray on.
    for (const int surfaces : {Tracer::kMaxDepth - 1, Tracer::kMaxDepth}) {
        CAPTURE(surfaces);
        std::string text = kGlow + "lit source sky 0 0 4 0 0 1 180\n";
        for (int i = 0; i < surfaces; ++i) {
            text += "void ring r" + std::to_string(i) + " 0 0 8 0 0 " + std::to_string(1 + i) +
                    " 0 0 1 0 9\n";
        }
        TestScene scene(text);
        const bool reached = surfaces < Tracer::kMaxDepth;
        CHECK(scene.trace({0, 0, 0}, {0, 0, 1}).value == (reached ? Rgb{2, 3, 4} : Rgb{}));
        CHECK(scene.context.path.nesting.rays == 0);
    }
}

TEST_CASE("tracer: a medium absorbs exponentially and glows with the ambient value") {
    // Beer and Lambert: L exp(-σ d), and the light scattered in from all around, albedo av (1 -
    // exp).
    const double sigma = 0.3, distance = 4;
    TestScene scene(kGlow + "lit sphere ball 0 0 4 0 0 5 1\n", with([](RenderOptions& options) {
                        options.extinction = Rgb::grey(0.3f);
                        options.albedo = Rgb::grey(0.5f);
                        options.ambient_value = Rgb::grey(0.7f);
                    }));
    const double left = std::exp(-sigma * distance);
    const double expected = 2 * left + 0.5 * 0.7 * (1 - left);
    // σ itself is kept in single precision, and so are the four factors.
    CHECK(std::abs(static_cast<double>(scene.trace({0, 0, 0}, {0, 0, 1}).value.r) - expected) <
          8 * kFloatStep * expected);
}

TEST_CASE("tracer: a value that is not finite counts as black and is told") {
    MemoryResources files;
    files.functions["bad.cal"] = "blow = 1e300 * 1e300;";
    TestScene scene(
        "void brightfunc b 2 blow bad.cal 0 0\nb glow lit 0 0 4 1 1 1 0\n"
        "lit sphere ball 0 0 4 0 0 5 1\n",
        TestScene::exact(), files);
    CHECK(scene.trace({0, 0, 0}, {0, 0, 1}).value == Rgb{});
    CHECK_FALSE(scene.warnings.messages.empty());
}

TEST_CASE("tracer: irradiance is π times the radiance of a sky that is the same everywhere") {
    TestScene scene(
        "void glow lit 0 0 4 1 1 1 0\nlit source sky 0 0 4 0 0 1 180\n"
        "void light lamp 0 0 3 5 5 5\nlamp source sun 0 0 4 0 0 1 .5\n");
    const Ray up = scene.tracer.irradiance({0, 0, 0}, {0, 0, 1}, RandomStream(1), scene.context);
    const Ray down = scene.tracer.irradiance({0, 0, 0}, {0, 0, -1}, RandomStream(1), scene.context);
    // The sun alone: a glow at infinity lights nothing directly. E = L Ω, Ω = 2π (1 - cos 0.25°).
    const double solid_angle = 2 * kPi * (1 - std::cos(0.25 * kPi / 180));
    // Ω comes from the cosine of a small angle in single precision: five digits are left.
    CHECK(static_cast<double>(up.value.r) == doctest::Approx(5 * solid_angle).epsilon(1e-5));
    CHECK(down.value == Rgb{});
}

TEST_CASE("tracer: counters tell rays by purpose") {
    TestScene scene(kMirror + kGlass + kGlow +
                        "silver ring low 0 0 8 0 0 0 0 0 1 0 9\n"
                        "pane ring high 0 0 8 0 0 4 0 0 1 0 9\n"
                        "lit source sky 0 0 4 0 0 1 180\n",
                    with([](RenderOptions& options) {
                        options.redirections = 0;
                        options.reflection_limit = 1;
                    }));
    (void)scene.trace({0, 0, 2}, {0, 0, -1});
    CHECK(scene.context.counters.rays.primary == 1);
    CHECK(scene.context.counters.rays.specular ==
          1);  // from the mirror; the pane's is one too many
    CHECK(scene.context.counters.rays.transmitted == 1);  // through the pane
    CHECK(scene.context.counters.rays.shadow == 0);
}

TEST_CASE("tracer: one context gives the same rays again, whatever it traced before") {
    TestScene scene(kMirror + kGlow +
                    "void plastic rough 0 0 5 .5 .5 .5 .1 .2\nrough sphere ball 0 0 4 0 0 0 1\n"
                    "void light lamp 0 0 3 9 9 9\nlamp sphere bulb 0 0 4 3 3 3 .2\n");
    const Rgb first = scene.trace({0, -4, 0}, {0, 1, 0.1}, 5).value;
    for (std::uint32_t i = 0; i < 20; ++i) (void)scene.trace({0, -4, 0}, {0, 1, 0.01 * i}, i);
    CHECK(scene.trace({0, -4, 0}, {0, 1, 0.1}, 5).value == first);
}

TEST_CASE(
    "tracer: one without indirect light takes the statistics of one with it, which are its own") {
    std::string text =
        "void light lamp 0 0 3 9 9 9\nvoid plastic grey 0 0 5 .5 .5 .5 0 0\n"
        "grey polygon floor 0 0 12 0 0 0 9 0 0 9 9 0 0 9 0\n"
        "grey polygon board 0 0 12 2 2 1 5 2 1 5 5 1 2 5 1\n";
    for (int i = 0; i < 40; ++i)
        text += "lamp sphere l" + std::to_string(i) + " 0 0 4 " + std::to_string(i % 8) + ' ' +
                std::to_string(i / 8) + " 2 .1\n";
    RenderOptions options = with([](RenderOptions& o) {
        o.shadow_threshold = .2;
        o.ambient_bounces = 1;
    });
    TestScene scene(text, options);
    options.ambient_bounces = 0;
    const Tracer own(scene.scene, options, scene.warnings);
    const Tracer taken(scene.scene, options, scene.warnings, SerialTaskRunner(),
                       &scene.tracer.lights().measures());
    REQUIRE(own.lights().all().size() == 40);
    std::size_t between = 0;
    for (std::int32_t i = 0; i < 40; ++i) {
        CHECK(taken.lights()[i].hit_rate == own.lights()[i].hit_rate);
        between += own.lights()[i].hit_rate > 0.5f && own.lights()[i].hit_rate < 1;
    }
    CHECK(between > 10);  // they have been measured
}
