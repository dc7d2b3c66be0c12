// Dimmers of a walk: what is shown under a mixture of light groups is what the scene shows whose
// sources are scaled, and nothing is traced for it.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/light/find_light_groups.h"
#include "parallel/concurrent_cache.h"
#include "parallel/walk/live_walk.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

constexpr int kDimWidth = 32, kDimHeight = 24;

/// A room with a lamp, a sky, a polished floor, a mirror and a window pane.
std::string room_with(const Rgb& lamp, const Rgb& sky) {
    const auto emission = [](const Rgb& scale, float r, float g, float b) {
        std::array<char, 120> text{};
        std::snprintf(text.data(), text.size(), "%.9g %.9g %.9g", static_cast<double>(scale.r * r),
                      static_cast<double>(scale.g * g), static_cast<double>(scale.b * b));
        return std::string(text.data());
    };
    return "void light lamp 0 0 3 " + emission(lamp, 40, 36, 30) + "\nvoid glow sky 0 0 4 " +
           emission(sky, 5, 6, 8) + R"( 0
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic polished 0 0 5 .3 .2 .1 .05 0
void plastic satin 0 0 5 .3 .3 .4 .04 .1
void mirror glass_mirror 0 0 3 .9 .9 .9
void glass pane 0 0 3 .9 .9 .9
polished polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon ceiling 0 0 12  -4 6 3  4 6 3  4 -6 3  -4 -6 3
grey polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
glass_mirror polygon right 0 0 12  4 6 0  4 -6 0  4 -6 3  4 6 3
pane polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
satin sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
sky source up 0 0 4 0 0 1 360
)";
}

RenderOptions light_options(int bounces, double accuracy = 0) {
    RenderOptions options;
    options.shadow_threshold = 0;  // no light is left out because others outshine it
    options.ambient_bounces = bounces;
    options.ambient_accuracy = accuracy;
    options.ambient_divisions = 16;
    options.ambient_super_samples = 0;
    return options;
}

View dim_view(double turned) {
    View view;
    view.position = {0, -4, 1.5};
    view.direction = {turned, 1, -0.05};
    view.horizontal = 70;
    view.vertical = 54.8;
    return view;
}

struct DimmedWalk {
    DimmedWalk(const Rgb& lamp, const Rgb& sky, int bounces, bool dimmable = true,
               double accuracy = 0)
        : room(room_with(lamp, sky)),
          direct(room.scene, light_options(0), room.warnings),
          full(room.scene, light_options(bounces, accuracy), room.warnings),
          cache(ambient_limits({-6, -6, -1}, 12, 0.2, 64)),
          executor(make_executor(ExecutorKind::threads, accuracy > 0 ? 1 : 2)),
          frames(direct, bounces > 0 ? &full : nullptr, cloud(), options(), *executor,
                 room.warnings),
          live(frames, 1) {
        if (accuracy > 0) full.use_ambient_cache(&cache);
        if (!dimmable) return;
        groups = std::make_shared<const LightGroups>(
            find_light_groups(room.scene, light_options(bounces), {}));
        frames.keep_groups(groups);
    }
    static CloudOptions cloud() {
        CloudOptions cloud;
        cloud.budget = 1;
        cloud.refine = 0.1;
        cloud.samples = 1;
        return cloud;
    }
    static FrameOptions options() {
        FrameOptions options;
        options.width = kDimWidth;
        options.height = kDimHeight;
        options.pixels.spacing = 1;
        return options;
    }
    LivePicture rest(double turned, WalkAmbient use) {
        for (int i = 0; i < 20000; ++i) {
            REQUIRE(live.next(dim_view(turned), kDimWidth, kDimHeight, use, 1e-2, stop));
            if (live.picture().phase == WalkPhase::done) return live.picture();
        }
        FAIL("it does not end");
        return {};
    }
    /// A frame by itself, of all pixels.
    Frame frame(double turned) {
        WalkFrame drawn = frames.draw(dim_view(turned), 0, 0, stop);
        REQUIRE(drawn.frame.complete);
        report = drawn.report;
        return std::move(drawn.frame);
    }
    [[nodiscard]] LightMixture mixture(const Rgb& lamp, const Rgb& sky) const {
        LightMixture mixture{std::vector<Rgb>(groups->size(), Rgb{1, 1, 1})};
        for (std::size_t g = 0; g < groups->size(); ++g)
            mixture.levels[g] = groups->names[g] == "lamp" ? lamp : sky;
        return mixture;
    }

    TestScene room;
    Tracer direct, full;
    ConcurrentCache cache;
    std::shared_ptr<const LightGroups> groups;
    std::unique_ptr<Executor> executor;
    StopFlag stop;
    LocalFrames frames;
    LiveWalk live;
    CloudReport report;
};

/// Share of the pixels that differ by more than a share of their brightest channel.
double share_apart(const std::vector<Rgb>& is, const std::vector<Rgb>& should, float share) {
    REQUIRE(is.size() == should.size());
    std::size_t apart = 0;
    for (std::size_t i = 0; i < is.size(); ++i) {
        const Rgb off = is[i] - should[i];
        const float most = std::max(max_component(off), -min_component(off));
        if (!(most <= share * max_component(should[i]))) ++apart;
    }
    return static_cast<double>(apart) / static_cast<double>(is.size());
}

const Rgb kAll{1, 1, 1}, kNone{0, 0, 0}, kWarm{1.5f, 1, 0.4f}, kDim{0.2f, 0.25f, 0.3f};

}  // namespace

TEST_CASE("dimmers: a view at rest is that of the scene whose sources are scaled, without a ray") {
    for (const int bounces : {0, 1}) {
        CAPTURE(bounces);
        const WalkAmbient use = bounces > 0 ? WalkAmbient::rest : WalkAmbient::off;
        DimmedWalk walk(kAll, kAll, bounces);
        const std::vector<Rgb> nominal = walk.rest(0, use).radiance;
        DimmedWalk plain(kAll, kAll, bounces, false);
        CHECK(plain.rest(0, use).radiance == nominal);  // to the bit
        const std::array<std::array<Rgb, 2>, 4> mixtures{
            {{kWarm, kDim}, {kNone, kAll}, {kAll, kNone}, {kDim, kWarm}}};
        for (const auto& [lamp, sky] : mixtures) {
            CAPTURE(lamp.r);
            CAPTURE(sky.r);
            REQUIRE(walk.live.mix(walk.mixture(lamp, sky)));
            DimmedWalk scaled(lamp, sky, bounces, false);
            CHECK(share_apart(walk.live.picture().radiance, scaled.rest(0, use).radiance, 1e-5f) ==
                  0);
            // What comes next at rest has nothing left to do.
            CHECK(share_apart(walk.rest(0, use).radiance, scaled.live.picture().radiance, 1e-5f) ==
                  0);
        }
        REQUIRE(walk.live.mix({}));
        CHECK(share_apart(walk.live.picture().radiance, nominal, 1e-6f) == 0);
    }
}

TEST_CASE("dimmers: what the cache of indirect light keeps is mixed as well") {
    // Halves are exact: a scene of half the light has the same records at the same places.
    const Rgb half{0.5f, 0.5f, 0.5f};
    DimmedWalk walk(kAll, kAll, 1, true, 0.2), scaled(half, half, 1, false, 0.2);
    const std::vector<Rgb> nominal = walk.rest(0, WalkAmbient::rest).radiance;
    REQUIRE(walk.live.mix(walk.mixture(half, half)));
    const std::vector<Rgb> halved = walk.live.picture().radiance;
    CHECK(share_apart(halved, scaled.rest(0, WalkAmbient::rest).radiance, 1e-5f) == 0);
    // And each group has its own part.
    std::vector<Rgb> sum(nominal.size());
    for (const auto& [lamp, sky] : {std::array{kAll, kNone}, std::array{kNone, kAll}}) {
        REQUIRE(walk.live.mix(walk.mixture(lamp, sky)));
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += walk.live.picture().radiance[i];
    }
    CHECK(share_apart(sum, nominal, 1e-5f) == 0);
}

TEST_CASE("dimmers: points of before show the mixture in the frames of another view") {
    DimmedWalk walk(kAll, kAll, 0), scaled(kWarm, kDim, 0, false), plain(kAll, kAll, 0, false);
    for (DimmedWalk* one : {&walk, &scaled, &plain}) {
        one->frames.begin(kDimWidth, kDimHeight, false);
        (void)one->frame(-0.02);
    }
    CHECK(walk.frame(0.01).radiance == plain.frame(0.01).radiance);  // also of the mirror's points
    (void)scaled.frame(0.01);
    (void)walk.frames.mix(walk.mixture(kWarm, kDim));
    const std::vector<Rgb> dimmed = walk.frame(0.03).radiance;
    CHECK(walk.report.reused > walk.report.pixels / 2);
    // Which points answer a pixel depends on the mixture where points differ.
    CHECK(share_apart(dimmed, scaled.frame(0.03).radiance, 1e-4f) < 0.02);
    // Pixels that are traced now leave points whose groups are kept, too.
    (void)walk.frames.mix(walk.mixture(kNone, kAll));
    DimmedWalk dark(kNone, kAll, 0, false);
    dark.frames.begin(kDimWidth, kDimHeight, false);
    for (const double turned : {-0.02, 0.01, 0.03}) (void)dark.frame(turned);
    CHECK(share_apart(walk.frame(0.05).radiance, dark.frame(0.05).radiance, 1e-4f) < 0.05);
    CHECK(walk.report.reused > walk.report.pixels / 2);
}

TEST_CASE("dimmers: while a view is not known as a whole the next frame is drawn in the mixture") {
    DimmedWalk walk(kAll, kAll, 0);
    const auto next = [&] {
        REQUIRE(
            walk.live.next(dim_view(0), kDimWidth, kDimHeight, WalkAmbient::off, 10, walk.stop));
    };
    next();
    CHECK_FALSE(walk.live.mix(walk.mixture(kNone, kWarm)));
    next();
    CHECK(walk.live.picture().phase == WalkPhase::moving);
    DimmedWalk scaled(kNone, kWarm, 0, false);
    CHECK(share_apart(walk.rest(0, WalkAmbient::off).radiance,
                      scaled.rest(0, WalkAmbient::off).radiance, 1e-5f) == 0);
}
