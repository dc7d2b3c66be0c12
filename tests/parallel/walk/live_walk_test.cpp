#include "parallel/walk/live_walk.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/view/view_path.h"
#include "parallel/concurrent_cache.h"
#include "parallel/frame.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

const std::string kLiveRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .6 .1 .1 0 0
void light lamp 0 0 3 40 40 40
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon ceiling 0 0 12  -4 6 3  4 6 3  4 -6 3  -4 -6 3
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
red polygon right 0 0 12  4 6 0  4 -6 0  4 -6 3  4 6 3
grey sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";
constexpr int kLiveWidth = 40, kLiveHeight = 30;

View view_at(double turned) {
    View view;
    view.position = {0, -4, 1.5};
    view.direction = {turned, 1, -0.05};
    view.horizontal = 60;
    view.vertical = 46.8;
    return view;
}

RenderOptions with_bounces(int bounces) {
    RenderOptions options;
    options.ambient_bounces = bounces;
    options.ambient_accuracy = 0;  // no cache: what a pixel gets depends on nothing else
    options.ambient_divisions = 16;
    options.ambient_value = Rgb::grey(0.1f);
    return options;
}

struct Walker {
    explicit Walker(int bounces, int samples = 1)
        : room(kLiveRoom),
          direct(room.scene, with_bounces(0), room.warnings),
          full(room.scene, with_bounces(bounces), room.warnings),
          executor(make_executor(ExecutorKind::threads, 2)),
          frames(direct, bounces > 0 ? &full : nullptr, cloud(samples), options(), *executor,
                 room.warnings),
          live(frames, samples) {}

    static CloudOptions cloud(int samples) {
        CloudOptions cloud;
        cloud.budget = 1;
        cloud.refine = 0.1;
        cloud.samples = samples;
        return cloud;
    }
    static FrameOptions options() {
        FrameOptions options;
        options.width = kLiveWidth;
        options.height = kLiveHeight;
        options.pixels.spacing = 1;
        return options;
    }
    LivePicture next(const View& view, WalkAmbient use, double budget = 1e-9) {
        REQUIRE(live.next(view, kLiveWidth, kLiveHeight, use, budget, stop));
        return live.picture();
    }
    /// The picture when nothing more comes; with what was said meanwhile.
    LivePicture rest(const View& view, WalkAmbient use, std::vector<LivePicture>* all = nullptr) {
        for (int i = 0; i < 20000; ++i) {
            LivePicture picture = next(view, use, 1e-3);
            if (all != nullptr) all->push_back(picture);
            if (picture.phase == WalkPhase::done) return picture;
        }
        FAIL("it does not end");
        return {};
    }
    Frame rendered(const Tracer& tracer, const View& view) {
        WorkerContexts contexts(tracer, room.warnings, executor->concurrency());
        return render_frame(tracer, Camera(view), options(), *executor, contexts, stop,
                            [](const FrameProgress&) {});
    }

    TestScene room;
    Tracer direct, full;
    std::unique_ptr<Executor> executor;
    StopFlag stop;
    LocalFrames frames;
    LiveWalk live;
};

}  // namespace

TEST_CASE("a view that rests ends as the picture that is rendered of it, whatever came before") {
    Walker walker(0);
    for (const double turned : {-0.1, -0.05, 0.0})
        (void)walker.next(view_at(turned), WalkAmbient::off);
    const LivePicture rested = walker.rest(view_at(0), WalkAmbient::off);
    CHECK(rested.radiance == walker.rendered(walker.direct, view_at(0)).radiance);
    CHECK(rested.distance == walker.rendered(walker.direct, view_at(0)).distance);
}

TEST_CASE("frames of another size are drawn from what those before have found") {
    Walker walker(0);
    const auto reused_at = [&](int width, int height, double turned) {
        REQUIRE(
            walker.live.next(view_at(turned), width, height, WalkAmbient::off, 10, walker.stop));
        const LivePicture& picture = walker.live.picture();
        CHECK(picture.width == width);
        CHECK(picture.height == height);
        CHECK(picture.radiance.size() ==
              static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        CHECK(picture.report.filled == 0);
        return static_cast<double>(picture.report.reused) /
               static_cast<double>(picture.report.pixels);
    };
    CHECK(reused_at(2 * kLiveWidth, 2 * kLiveHeight, -0.02) == 0);
    CHECK(reused_at(kLiveWidth, kLiveHeight, -0.01) > 0.9);
    CHECK(reused_at(2 * kLiveWidth, 2 * kLiveHeight, 0) > 0.5);
    const LivePicture rested = walker.rest(view_at(0), WalkAmbient::off);
    CHECK(rested.radiance == walker.rendered(walker.direct, view_at(0)).radiance);
}

TEST_CASE("indirect light comes while a view rests, and ends as the picture that is rendered") {
    Walker walker(1);
    const View view = view_at(0);
    const Frame truth = walker.rendered(walker.full, view);
    const Frame direct = walker.rendered(walker.direct, view);
    std::vector<LivePicture> all;
    CHECK(walker.rest(view, WalkAmbient::rest, &all).radiance == truth.radiance);
    const auto error = [&](const std::vector<Rgb>& radiance) {
        double sum = 0;
        for (std::size_t i = 0; i < radiance.size(); ++i)
            sum += static_cast<double>(
                std::abs(brightness(radiance[i]) - brightness(truth.radiance[i])));
        return sum;
    };
    // Long before all pixels are traced they look more like it than what the frames had.
    const auto early = std::find_if(all.begin(), all.end(), [](const LivePicture& picture) {
        return picture.phase == WalkPhase::ambient && picture.share > 0.1;
    });
    REQUIRE(early != all.end());
    CHECK(early->share < 0.5);
    CHECK(error(early->radiance) < 0.5 * error(direct.radiance));
}

TEST_CASE("a draft of indirect light comes first, is told as such, and nothing of it stays") {
    Walker walker(1);
    const View view = view_at(0);
    const Frame truth = walker.rendered(walker.full, view);
    std::vector<LivePicture> all;
    const LivePicture last = walker.rest(view, WalkAmbient::rest, &all);
    CHECK(last.inferred == 0);
    CHECK(last.radiance == truth.radiance);
    const auto first = std::find_if(
        all.begin(), all.end(), [](const LivePicture& picture) { return picture.inferred > 0; });
    REQUIRE(first != all.end());
    CHECK(first->inferred == 1);
    CHECK(first->phase == WalkPhase::filling);
    for (auto picture = first; picture != all.end(); ++picture) {
        if (picture->phase == WalkPhase::filling) CHECK(picture->inferred == 1);
        if (picture->phase == WalkPhase::ambient)
            CHECK(picture->inferred == doctest::Approx(1 - picture->share));
    }
    const auto light = std::find_if(all.begin(), all.end(), [](const LivePicture& picture) {
        return picture.phase == WalkPhase::ambient;
    });
    REQUIRE(light != all.end());
    CHECK(std::none_of(all.begin(), light, [](const LivePicture& picture) {
        return picture.phase == WalkPhase::refining;  // light is to come
    }));
    double error = 0, sum = 0;
    for (std::size_t i = 0; i < truth.radiance.size(); ++i) {
        const Rgb &drafted = light->radiance[i], &right = truth.radiance[i];
        error += static_cast<double>(std::abs(brightness(drafted) - brightness(right)));
        sum += static_cast<double>(brightness(right));
    }
    CHECK(error < 0.1 * sum);  // both are of few rays
    CHECK(walker.next(view_at(0.05), WalkAmbient::rest).inferred == 0);
}

TEST_CASE("indirect light is always there, or never, where that is asked for") {
    Walker walker(1);
    CHECK(walker.rest(view_at(0), WalkAmbient::always).radiance ==
          walker.rendered(walker.full, view_at(0)).radiance);
    CHECK(walker.rest(view_at(0), WalkAmbient::off).radiance ==
          walker.rendered(walker.direct, view_at(0)).radiance);
}

TEST_CASE("a view that moves on leaves what it was doing, and is told from one that rests") {
    Walker walker(1);
    (void)walker.rest(view_at(0), WalkAmbient::rest);
    const LivePicture moved = walker.next(view_at(0.05), WalkAmbient::rest);
    CHECK(moved.phase == WalkPhase::moving);
    CHECK(moved.radiance.size() == kLiveWidth * kLiveHeight);
    CHECK(walker.next(view_at(0.05), WalkAmbient::rest).phase != WalkPhase::moving);
    REQUIRE(walker.live.next(view_at(0.05), 20, 15, WalkAmbient::rest, 1, walker.stop));
    CHECK(walker.live.picture().radiance.size() == 300);
}

TEST_CASE("an eye that has rested finds what lies beside its view when it turns") {
    const View view = view_at(0);
    constexpr double kEnough = 0.5;  // [s] for a step: so that none of the views is left out
    const auto reused = [&](Walker& walker) {
        LivePicture rested = walker.next(view, WalkAmbient::off, kEnough);
        for (int i = 0; rested.phase != WalkPhase::done; ++i) {
            REQUIRE(i < 1000);
            rested = walker.next(view, WalkAmbient::off, kEnough);
        }
        CHECK(rested.radiance == walker.rendered(walker.direct, view).radiance);
        const LivePicture turned = walker.next(turned_view(view, 75), WalkAmbient::off);
        CHECK(turned.is_new);
        return static_cast<double>(turned.report.reused) /
               static_cast<double>(turned.report.pixels);
    };
    Walker stares(0), looks(0);
    looks.live.look_around(true);
    CHECK(reused(stares) == 0);
    CHECK(reused(looks) > 0.7);
}

TEST_CASE("looking around changes nothing of a picture at rest, nor of its light") {
    Walker walker(1);
    walker.live.look_around(true);
    const View view = view_at(0);
    std::vector<LivePicture> all;
    CHECK(walker.rest(view, WalkAmbient::rest, &all).radiance ==
          walker.rendered(walker.full, view).radiance);
    std::size_t aside = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
        if (all[i].is_new) continue;
        ++aside;
        CHECK(all[i].radiance == all[i - 1].radiance);
        CHECK(all[i].phase == all[i - 1].phase);
    }
    CHECK(aside > 2);
    for (int i = 0; walker.live.has_more_around(); ++i) {
        REQUIRE(i < 1000);
        CHECK_FALSE(walker.next(view, WalkAmbient::rest, 1e-3).is_new);
        CHECK(walker.live.picture().phase == WalkPhase::done);
    }
    // There again later nothing is to be looked at any more.
    (void)walker.next(view_at(0.05), WalkAmbient::rest);
    all.clear();
    (void)walker.rest(view, WalkAmbient::rest, &all);
    CHECK(std::ranges::all_of(all, &LivePicture::is_new));
    walker.live.begin_anew();
    all.clear();
    (void)walker.rest(view, WalkAmbient::rest, &all);
    CHECK_FALSE(std::ranges::all_of(all, &LivePicture::is_new));
    // Frames of another light begin without points.
    all.clear();
    (void)walker.rest(view, WalkAmbient::off, &all);
    CHECK_FALSE(std::ranges::all_of(all, &LivePicture::is_new));
}

TEST_CASE("where there is time a view comes to rest in few steps, however edges spread") {
    Walker walker(0, 8);
    int steps = 0;
    do {
        ++steps;
        REQUIRE(steps < 60);
    } while (walker.next(view_at(0), WalkAmbient::off, 100).phase != WalkPhase::done);
}

TEST_CASE("edges get more rays where a view rests, other pixels do not") {
    Walker once(0), often(0, 4);
    const LivePicture plain = once.rest(view_at(0), WalkAmbient::off);
    const LivePicture smooth = often.rest(view_at(0), WalkAmbient::off);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < plain.radiance.size(); ++i)
        changed += plain.radiance[i] == smooth.radiance[i] ? 0 : 1;
    CHECK(changed > 0);
    CHECK(changed < plain.radiance.size() / 2);
}
