#include "core/trace/light_sampler.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/math/xyz.h"
#include "tests/core/trace/white_room.h"
#include "tests/one_thread.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const Vec3 kSensor{.8, .3, .5}, kUp{0, 0, 1};

}  // namespace

TEST_CASE("light sampler: intervals hold the light that large hemispheres find, 95 times in 100" *
          about_numbers) {
    TestScene scene(kWhiteRoom, two_bounces());
    const double truth = illuminance_of(scene, kSensor, kUp);
    LightSampler sampler(scene.tracer, scene.warnings);
    constexpr int kTries = 400, kSamples = 12;
    int held = 0, half = 0;
    double bias = 0, width = 0;
    for (std::uint32_t seed = 0; seed < kTries; ++seed) {
        LightBatches light;
        for (std::uint32_t i = 0; i < kSamples; ++i)
            light.add(sampler.irradiance(kSensor, kUp, sampler.random(seed, i)));
        const MeanInterval found =
            light.interval([&](const SampledLight& part) { return sampler.shown(part); });
        const double off = found.mean - truth;
        held += std::abs(off) <= found.half_width ? 1 : 0;
        half += std::abs(off) <= found.half_width / 2 ? 1 : 0;
        bias += off / kTries;
        width += found.half_width / kTries;
    }
    // Three standard deviations of a share of 400 are .033.
    CHECK(double(held) / kTries > .917);
    CHECK(double(held) / kTries < .983);
    CHECK(double(half) / kTries < .85);
    CHECK(std::abs(bias) < .2 * width);
    CHECK(width < .1 * truth);
}

TEST_CASE("light sampler: light without chance has an interval of nothing") {
    RenderOptions options = two_bounces();
    options.ambient_bounces = 0;
    TestScene scene(kWhiteRoom, options);
    LightSampler sampler(scene.tracer, scene.warnings);
    LightBatches light;
    for (std::uint32_t i = 0; i < 37; ++i)
        light.add(sampler.irradiance(kSensor, kUp, sampler.random(0, i)));
    const MeanInterval found =
        light.interval([&](const SampledLight& part) { return sampler.shown(part); });
    CHECK(found.half_width == 0);
    CHECK(found.mean ==
          double{kEfficacy} *
              static_cast<double>(brightness(
                  scene.tracer.irradiance(kSensor, kUp, RandomStream(1), scene.context).value)));
}

TEST_CASE("light sampler: batches of many samples tell their mean, and an interval from two on") {
    LightBatches light;
    const auto green = [](const SampledLight& part) { return static_cast<double>(part.whole.g); };
    light.add({{0, 1, 0}, {}});
    CHECK(light.interval(green).mean == 1);
    CHECK(std::isinf(light.interval(green).half_width));
    for (int i = 2; i <= 100; ++i) light.add({{0, static_cast<float>(i), 0}, {}});
    CHECK(light.count() == 100);
    CHECK(light.interval(green).mean == doctest::Approx(50.5));
    CHECK(std::isfinite(light.interval(green).half_width));
    light.clear();
    CHECK(light.count() == 0);
}

TEST_CASE("light sampler: a dimmed light is told with its interval, and no ray is traced for it") {
    TestScene scene(kWhiteRoom, two_bounces());
    auto groups = std::make_shared<LightGroups>();
    groups->names = {"lamp", kRestGroup};
    groups->of_constant = 1;
    groups->of_modifier.assign(16, 1);
    for (std::size_t i = 0; i < scene.scene.own_modifiers().size(); ++i)
        if (scene.scene.own_modifiers()[i].name == "lamp") groups->of_modifier[i] = 0;
    LightSampler sampler(scene.tracer, scene.warnings, groups);
    LightBatches light;
    for (std::uint32_t i = 0; i < 20; ++i)
        light.add(sampler.irradiance(kSensor, kUp, sampler.random(0, i)));
    const auto told = [&] {
        return light.interval([&](const SampledLight& part) { return sampler.shown(part); });
    };
    const MeanInterval whole = told();
    sampler.mix({{{.5f, .5f, .5f}, {1, 1, 1}}});
    CHECK(whole.half_width > 0);
    CHECK(told().mean == doctest::Approx(whole.mean / 2).epsilon(1e-5));
    CHECK(told().half_width == doctest::Approx(whole.half_width / 2).epsilon(1e-4));
}
