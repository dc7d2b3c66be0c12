#include "core/light/light_sources.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

std::string distant(const std::string& material, const std::string& arguments,
                    const std::string& name, const std::string& cone) {
    return "void " + material + " m_" + name + "\n0\n0\n" + arguments + "\nm_" + name + " source " +
           name + "\n0\n0\n4 " + cone + "\n";
}

const std::string kGlow = distant("glow", "4 1 2 3 0", "sky", "0 0 1 180");
const std::string kSun = distant("light", "3 9 9 9", "sun", "0 0 1 10");
const std::string kIllum = distant("illum", "3 5 5 5", "veil", "0 0 1 40");

std::string seen(const std::string& text, const Vec3& direction, std::uint16_t history = kPrimary,
                 std::int32_t target = kNoTarget) {
    TestScene scene(text);
    Ray ray = scene.tracer.primary({}, direction, 0, {});
    ray.history |= history;
    ray.target = target;
    const auto surface = scene.tracer.lights().background(ray);
    return surface ? std::string(scene.scene.surface(*surface).name()) : "nothing";
}

}  // namespace

TEST_CASE("background: lights before glows whatever the order, glows elsewhere, black beyond") {
    for (const std::string& text : {kGlow + kSun, kSun + kGlow}) {
        CHECK(seen(text, {0, 0, 1}) == "sun");
        CHECK(seen(text, {1, 0, 1}) == "sky");
        CHECK(seen(text, {1, 0, -0.1}) == "nothing");
    }
    CHECK(seen(kGlow, {1, 0, 0}) == "sky");  // the horizon belongs to a half sky
    CHECK(seen(distant("light", "3 1 1 1", "a", "0 0 1 20") + kSun, {0, 0, 1}) == "a");
}

TEST_CASE("background: an illum is seen through, and hides what is behind from indirect rays") {
    const std::string text = kIllum + kGlow;
    CHECK(seen(text, {0, 0, 1}) == "sky");
    CHECK(seen(text, {0, 0, 1}, kAmbientSame) == "nothing");
    CHECK(seen(text, {0, 0, 1}, kSpecularReflected) == "nothing");
    CHECK(seen(text, {1, 0, 0.2}, kAmbientSame) == "sky");
    CHECK(seen(kIllum, {0, 0, 1}) == "nothing");
}

TEST_CASE("background: a ray that is aimed at a source sees that source only") {
    const std::string text = kSun + kIllum + kGlow;
    CHECK(seen(text, {0, 0, 1}, kShadow, 1) == "veil");
    CHECK(seen(text, {0, 0, 1}, kShadow, 0) == "sun");
    CHECK(seen(text, {1, 0, 1}, kShadow, 0) == "nothing");
    const std::string lamp = "void light l\n0\n0\n3 1 1 1\nl sphere s\n0\n0\n4 0 0 9 1\n";
    CHECK(seen(lamp + kGlow, {1, 0, 1}, kShadow, 0) == "nothing");
}

TEST_CASE("aimed rays meet their own source and nothing else") {
    TestScene scene(
        "void light l\n0\n0\n3 1 1 1\nl sphere s\n0\n0\n4 0 0 9 1\nvoid plastic p\n0\n0\n5 1 1 1 0 "
        "0\n"
        "p sphere t\n0\n0\n4 0 0 5 1\n" +
        kSun);
    Ray ray = scene.tracer.primary({}, {0, 0, 1}, 0, {});
    ray.target = 0;
    REQUIRE(scene.tracer.lights().intersect_target(ray, scene.tracer));
    CHECK(ray.hit.t == rounded(8));
    ray.direction = {0, 1, 0};
    CHECK_FALSE(scene.tracer.lights().intersect_target(ray, scene.tracer));
    ray.target = 1;
    CHECK_FALSE(scene.tracer.lights().intersect_target(ray, scene.tracer));
    ray.direction = {0, 0, 1};
    REQUIRE(scene.tracer.lights().intersect_target(ray, scene.tracer));
    CHECK(ray.hit.t == kHuge);
    CHECK(ray.hit.normal == Vec3{0, 0, -1});
}

TEST_CASE("in-scatter: the mean over random steps is the integral along the ray") {
    const std::string lamp = "void light l\n0\n0\n3 100 100 100\nl sphere s\n0\n0\n4 0 1 1 .1\n";
    constexpr double kLength = 2, kSigma = 0.3, kAlbedo = 0.5;
    for (const double g : {0.0, 0.6}) {
        CAPTURE(g);
        RenderOptions options = TestScene::exact();
        options.scatter_step = 0.2;
        TestScene scene(lamp, options);
        const ScatterList list{{0}};
        double sum = 0;
        constexpr int kRays = 500;
        for (std::uint64_t i = 0; i < kRays; ++i) {
            Ray ray = scene.tracer.primary({}, {0, 0, 1}, 0, RandomStream(i));
            ray.medium = {Rgb::grey(kSigma), Rgb::grey(kAlbedo), static_cast<float>(g), &list};
            ray.hit.t = kLength;
            scene.tracer.lights().add_in_scatter(ray, scene.context);
            sum += static_cast<double>(ray.value.g) / kRays;
        }
        double integral = 0;
        constexpr int kSteps = 2000;
        for (int i = 0; i < kSteps; ++i) {
            const double z = kLength * (i + 0.5) / kSteps, d = std::sqrt(1 + (1 - z) * (1 - z));
            const double cosine = (1 - z) / d;
            const double phase =
                (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5) / (4 * kPi);
            // The lamp's light loses only what is absorbed, up to its surface.
            integral += 100 * std::exp(-kSigma * (1 - kAlbedo) * (d - 0.1)) * kPi * 0.01 / (d * d) *
                        phase * kSigma * kAlbedo * std::exp(-kSigma * z) * kLength / kSteps;
        }
        // 500 rays of about ten random steps each: 5000 samples of a smooth function.
        CHECK(sum == within(0.005, integral));
    }
}

TEST_CASE("in-scatter: nothing without listed sources, at infinity, or straight forward") {
    TestScene scene("void light l\n0\n0\n3 100 100 100\nl sphere s\n0\n0\n4 0 1 1 .1\n");
    const ScatterList list{{0}}, none;
    const auto scattered = [&](double t, float g, const ScatterList* scatter) {
        Ray ray = scene.tracer.primary({}, {0, 0, 1}, 0, {});
        ray.medium = {Rgb::grey(0.3f), Rgb::grey(0.5f), g, scatter};
        ray.hit.t = t;
        scene.tracer.lights().add_in_scatter(ray, scene.context);
        return ray.value.g;
    };
    CHECK(scattered(2, 0, &list) > 0);
    CHECK(scattered(2, 0, &none) == 0);
    CHECK(scattered(2, 0, nullptr) == 0);
    CHECK(scattered(2, 1, &list) == 0);
    CHECK(scattered(kHuge, 0, &list) == 0);
}
