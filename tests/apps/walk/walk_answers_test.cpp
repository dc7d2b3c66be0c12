// What a walk says of light, and how well it knows it.
#include "apps/walk/walk_answers.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/math/xyz.h"
#include "parallel/walk/scene_caster.h"
#include "tests/core/trace/white_room.h"
#include "tests/one_thread.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const Vec3 kCornerEye{-1.5, -1.5, 1.5};
const std::vector<ProbePlace> kTwoPins{{3, {.8, .3, 0}, {0, 0, 1}}, {5, {2, -1, 1.2}, {-1, 0, 0}}};

bool holds(const MeanInterval& interval, double truth) {
    return std::abs(interval.mean - truth) <= interval.half_width;
}

ProbesReply settled_reply(WalkAnswers& answers, const std::vector<ProbePlace>& pins = kTwoPins) {
    ProbesReply reply;
    do reply = answers.measure(pins, kCornerEye, .01);
    while (reply.settled < 1);
    return reply;
}

View view_of_corner() {
    View view;
    view.position = kCornerEye;
    view.direction = normalize(Vec3{1, .6, -.2});
    view.horizontal = view.vertical = 60;
    return view;
}

}  // namespace

TEST_CASE("walk answers: the interval of a pin narrows, and holds what long runs find" *
          about_numbers) {
    TestScene scene(kWhiteRoom, two_bounces());
    WalkAnswers answers(scene.tracer, scene.warnings);
    const ProbesReply first = answers.measure(kTwoPins, kCornerEye, 0);
    REQUIRE(first.probes.size() == kTwoPins.size());
    CHECK(first.settled > 0);
    CHECK(first.settled < .1);
    const ProbesReply last = settled_reply(answers);
    for (std::size_t i = 0; i < kTwoPins.size(); ++i) {
        CAPTURE(i);
        CHECK(last.probes[i].id == kTwoPins[i].id);
        const MeanInterval& lux = last.probes[i].illuminance;
        CHECK(lux.half_width < first.probes[i].illuminance.half_width);
        CHECK(lux.half_width > 0);
        CHECK(lux.half_width < .01 * lux.mean);
        const double truth = illuminance_of(scene, kTwoPins[i].position, kTwoPins[i].normal);
        CHECK(std::abs(lux.mean - truth) < 2 * lux.half_width);
        // Diffuse: the luminance is what falls on the surface times its reflectance over pi.
        const double reflectance = brightness({.7f, .6f, .5f});
        const MeanInterval& seen = last.probes[i].luminance;
        CHECK(std::abs(seen.mean - reflectance / kPi * truth) < 2 * seen.half_width + .003 * truth);
    }
}

TEST_CASE("walk answers: what is known of a pin is of its place, and of where the eye is") {
    TestScene scene(kWhiteRoom, two_bounces());
    WalkAnswers answers(scene.tracer, scene.warnings);
    const ProbesReply last = settled_reply(answers);
    const ProbesReply moved = answers.measure(kTwoPins, {1, 1, 1.5}, 0);
    for (std::size_t i = 0; i < kTwoPins.size(); ++i) {
        CHECK(moved.probes[i].illuminance.mean == last.probes[i].illuminance.mean);
        CHECK(moved.probes[i].luminance.half_width > 2 * last.probes[i].luminance.half_width);
    }
    std::vector<ProbePlace> pins = kTwoPins;
    pins[1].position = {2, 1, 2.5};
    const ProbesReply other = answers.measure(pins, {1, 1, 1.5}, 0);
    CHECK(other.probes[0].illuminance.mean == last.probes[0].illuminance.mean);
    CHECK(other.probes[1].illuminance.half_width > 2 * last.probes[1].illuminance.half_width);
    CHECK(answers.measure({}, kCornerEye, 0).probes.empty());
    CHECK(answers.measure({}, kCornerEye, 0).settled == 1);
    CHECK(answers.known().probes.empty());
}

TEST_CASE("walk answers: light without chance is known exactly, wherever somebody points") {
    RenderOptions options = two_bounces();
    options.ambient_bounces = 0;
    TestScene scene(kWhiteRoom, options);
    WalkAnswers answers(scene.tracer, scene.warnings);
    const ProbesReply pins = settled_reply(answers);
    const PickedReply pick = answers.pick({1, .5, .5, {}}, Camera(view_of_corner()), {.01, .01});
    for (const MeanInterval& number :
         {pins.probes[0].illuminance, pins.probes[0].luminance, pick.luminance, pick.illuminance}) {
        CHECK(number.mean > 0);
        CHECK(number.half_width == 0);
    }
}

TEST_CASE("walk answers: where somebody points luminance and illuminance agree within intervals") {
    TestScene scene(kWhiteRoom, two_bounces());
    WalkAnswers answers(scene.tracer, scene.warnings);
    const PickedReply pick = answers.pick({1, .5, .5, {}}, Camera(view_of_corner()), {.01, .01});
    REQUIRE(pick.hit);
    const double truth = illuminance_of(scene, pick.position, pick.normal);
    const double reflectance = brightness({.7f, .6f, .5f});
    CHECK(pick.illuminance.half_width > 0);
    CHECK(pick.illuminance.half_width < .2 * truth);
    CHECK(std::abs(pick.illuminance.mean - truth) < 2 * pick.illuminance.half_width);
    CHECK(std::abs(pick.luminance.mean - reflectance / kPi * truth) <
          2 * pick.luminance.half_width + .01 * truth);
}

TEST_CASE("walk answers: a mean holds the truth, also of a picture that is too dark everywhere" *
          about_numbers) {
    TestScene scene(kWhiteRoom, two_bounces());
    LivePicture picture;
    picture.width = 20;
    picture.height = 12;
    const View view = view_of_corner();
    const Camera camera(view);
    FrameOptions options;
    options.pixels.spacing = 1;
    FrameOptions sized = options;
    sized.width = picture.width;
    sized.height = picture.height;
    const PixelRays rays = rays_of_sample(camera, sized, 0);
    double truth = 0;
    LightSampler sampler(scene.tracer, scene.warnings);
    for (int row = 0; row < picture.height; ++row)
        for (int x = 0; x < picture.width; ++x) {
            const auto ray = rays(x, picture.height - 1 - row).ray;
            SampledLight mean;
            constexpr int kSamples = 64;
            for (std::uint32_t i = 0; i < kSamples; ++i)
                mean.whole +=
                    1.f / kSamples *
                    sampler
                        .radiance(ray->origin, ray->direction, ray->limit,
                                  sampler.random(77, i + kSamples * picture.radiance.size()))
                        .whole;
            picture.radiance.push_back(.8f * mean.whole);
            if (x >= 5 && x < 15) truth += sampler.shown(mean) / (10 * picture.height);
        }
    int held = 0;
    constexpr int kSeeds = 40;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        RenderOptions light = two_bounces();
        light.seed = seed;
        const Tracer tracer(scene.scene, light, scene.warnings);
        WalkAnswers answers(tracer, scene.warnings);
        const MeanReply reply = answers.mean({8, .25, 0, .75, 1}, picture, view, options);
        CHECK(reply.pixels == 120);
        CHECK(reply.luminance.half_width < .1 * truth);
        held += holds(reply.luminance, truth) ? 1 : 0;
    }
    CHECK(held >= 34);  // of 40 fewer are within 95 % once in some thousand times
}
