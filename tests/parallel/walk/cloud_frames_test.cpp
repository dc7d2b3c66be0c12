#include "parallel/walk/cloud_frames.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/cloud/gaps.h"
#include "core/math/random.h"
#include "parallel/frame.h"
#include "parallel/walk/cloud_region.h"
#include "parallel/walk/scene_caster.h"
#include "parallel/walk/uncached_pixel_tracer.h"
#include "tests/one_thread.h"
#include "tests/parallel/walk/cloud_room.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::about_numbers;
using lightwalk::test::one_thread;
using lightwalk::test::TestScene;
using namespace lightwalk::test::cloud_room;

namespace {

const char* const kWalks[] = {"turn", "forward", "backward", "sideways"};

}  // namespace

TEST_CASE("cloud: the first frame is the picture, every pixel traced" * one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudFrames frames(kWidth, kHeight, {});
    const View view = view_at(0, 0, 0);
    const CloudFrame first = room.draw(frames, view, *executor);
    WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 1);
    const Frame picture = render_frame(room.scene.tracer, Camera(view), frame_options(), *executor,
                                       contexts, room.stop, [](const FrameProgress&) {});
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            const auto j = static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x);
            CHECK(first.radiance[i] == picture.radiance[j]);
            CHECK(first.distance[i] == picture.distance[j]);
        }
    }
    CHECK(first.report.uncached[static_cast<std::size_t>(TraceCause::uncovered)] ==
          first.report.pixels);
}

TEST_CASE("cloud: a view that stands still is reused whole, but for what nobody can tell") {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudFrames frames(kWidth, kHeight, {});
    const CloudFrame first = room.draw(frames, view_at(0, 0, 0), *executor);
    const CloudFrame second = room.draw(frames, view_at(0, 0, 0), *executor);
    CHECK(second.report.reused == second.report.pixels);
    // Sums of two points differ from what was traced by rounding.
    for (std::size_t i = 0; i < first.radiance.size(); ++i)
        CHECK(std::abs(second.radiance[i].g - first.radiance[i].g) <=
              1e-6f * (1 + first.radiance[i].g));
}

TEST_CASE("cloud: mirrors, panes, polished floors and hidden things are true in motion" *
          about_numbers) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    for (const std::string walk : kWalks) {
        CAPTURE(walk);
        CloudFrames frames(kWidth, kHeight, {});
        // The floor: what the picture moved by half a pixel is off.
        std::size_t off = 0, off_mirrored = 0, floor = 0, floor_mirrored = 0, reused = 0;
        for (int i = 0; i < 12; ++i) {
            View view = view_of(walk, i);
            const CloudFrame frame = room.draw(frames, view, *executor);
            if (i > 0) reused += frame.report.reused;
            if (i % 4 != 3) continue;  // what has been reused for long tells most
            const std::vector<TracedPixel> truth = room.truth(view);
            view.shift = 0.5 / kWidth;
            view.lift = 0.5 / kHeight;
            const std::vector<Rgb> moved = radiance_of(room.truth(view));
            off += off_by_a_tenth(frame.radiance, truth);
            off_mirrored += off_by_a_tenth(frame.radiance, truth, true);
            floor += off_by_a_tenth(moved, truth);
            floor_mirrored += off_by_a_tenth(moved, truth, true);
        }
        const auto share = [](std::size_t count, int of_frames = 3) {
            return static_cast<double>(count) / (double{kWidth} * kHeight * of_frames);
        };
        MESSAGE(walk << ": reused " << share(reused, 11) << ", off " << share(off) << " (floor "
                     << share(floor) << "), of these with mirrors " << share(off_mirrored)
                     << " (floor " << share(floor_mirrored) << ")");
        CHECK(share(off) < share(floor) + 0.01);
        CHECK(share(off_mirrored) < share(floor_mirrored) + 0.01);
        CHECK(share(reused, 11) > 0.9);
    }
}

TEST_CASE("cloud: the same bytes with any number of threads, in every mode") {
    Room room;
    for (const CloudCheck check :
         {CloudCheck::all, CloudCheck::rotating, CloudCheck::edges, CloudCheck::none}) {
        CloudOptions options;
        options.check = check;
        options.audit = 0.02;
        options.supersaturated = check != CloudCheck::edges;
        options.limit = 1.5;
        std::vector<std::vector<Rgb>> expected;
        for (const int workers : {1, 2, 7}) {
            const auto executor =
                make_executor(workers == 1 ? ExecutorKind::serial : ExecutorKind::threads, workers);
            CloudFrames frames(kWidth, kHeight, options);
            for (std::size_t i = 0; i < 6; ++i) {
                const CloudFrame frame = room.draw(
                    frames, view_of(i < 3 ? "forward" : "turn", static_cast<int>(i)), *executor);
                if (workers == 1)
                    expected.push_back(frame.radiance);
                else
                    CHECK(frame.radiance == expected[i]);
                CHECK(frames.points().size() <= kWidth * kHeight * 3 / 2);
            }
        }
    }
}

TEST_CASE("cloud: a rotating check spares pixels in each frame, and none of them for long" *
          one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudFrames frames(kWidth, kHeight, rotating());
    const std::size_t pixels = room.seen.size();
    (void)room.draw(frames, view_at(0, 0, 0), *executor);
    CHECK(room.looked == 0);
    for (int i = 1; i <= 20; ++i) {
        room.looked = 0;
        (void)room.draw(frames, view_at(0, 0, 0.0002 * i), *executor);
        CHECK(room.looked.load() > pixels / 3);
        CHECK(room.looked.load() < pixels * 9 / 10);  // much of the room is mirrored somewhere
    }
    CHECK(std::count(room.seen.begin(), room.seen.end(), 0) == 0);
}

TEST_CASE("cloud: a frame that has no time to look shows what points say, and the next one looks" *
          one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudFrames frames(kWidth, kHeight, rotating());
    (void)room.draw(frames, view_at(0, 0, 0), *executor);
    frames.set_budget(1e-9);
    const CloudFrame hurried = room.draw(frames, view_at(0, 0, 0.001), *executor);
    CHECK(room.looked == 0);
    CHECK(hurried.complete);
    CHECK(hurried.report.reused > room.seen.size() / 2);
    const std::vector<TracedPixel> truth = room.truth(view_at(0, 0, 0.001));
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const float is = brightness(hurried.radiance[i]), should = brightness(truth[i].radiance);
        if (std::abs(is - should) > 0.1f * should) ++off;
    }
    CHECK(off < truth.size() / 4);
    frames.set_budget(0);
    (void)room.draw(frames, view_at(0, 0, 0.002), *executor);
    CHECK(room.looked > 0);
}

TEST_CASE(
    "cloud: where nearly nothing is known coarse grids come first, and the rest comes in time" *
    one_thread) {
    Room room(kWidth / 2, kHeight / 2);
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudOptions options = rotating();
    options.budget = 1e-9;
    CloudFrames frames(room.width, room.height, options);
    std::size_t reused = 0;
    for (int i = 0; i < 1200 && reused <= room.seen.size() / 2; ++i) {
        const CloudFrame frame = room.draw(frames, view_at(0, 0, 1e-5 * i), *executor);
        const CloudReport& report = frame.report;
        std::size_t traced = 0;
        for (std::size_t cause = 0; cause < kTraceCauses; ++cause)
            if (static_cast<TraceCause>(cause) != TraceCause::audited)
                traced += report.uncached[cause];
        REQUIRE(report.reused + report.filled + traced == report.pixels);
        if (i == 1) {
            for (std::size_t at = 0; at < frame.causes.size(); ++at) {
                const PixelPlace place{static_cast<int>(at) % room.width,
                                       static_cast<int>(at) / room.width};
                const bool kept = frame.causes[at] == TraceCause::none;
                if (kept || frame.distance[at] > 0) CHECK(grid_level(place) <= 1);
            }
        }
        reused = report.reused;
    }
    CHECK(reused > room.seen.size() / 2);
}

TEST_CASE("cloud: a frame that is stopped leaves the cloud as it was") {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudFrames frames(kWidth, kHeight, {});
    (void)room.draw(frames, view_at(0, 0, 0), *executor);
    const std::vector<CloudPoint> before(frames.points().begin(), frames.points().end());
    room.stop.request();
    CHECK(!room.draw(frames, view_at(0.5, 0, 0), *executor).complete);
    CHECK(std::equal(before.begin(), before.end(), frames.points().begin(), frames.points().end()));
}

TEST_CASE("cloud: what a budget leaves out is filled from around, and traced in time") {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudOptions options;
    options.budget = 1e-9;  // the least that a frame traces
    options.refine = 0.25;
    CloudFrames frames(kWidth, kHeight, options);
    const View view = view_at(0, 0, 0);
    const CloudFrame first = room.draw(frames, view, *executor);
    const std::size_t traced =
        first.report.uncached[static_cast<std::size_t>(TraceCause::uncovered)];
    CHECK(traced > 0);
    CHECK(traced < first.report.pixels / 10);
    CHECK(first.report.filled == first.report.pixels - traced);
    // Black is only what lies between pixels that are.
    const auto black = std::count_if(first.radiance.begin(), first.radiance.end(),
                                     [](const Rgb& color) { return !(color.g > 0); });
    CHECK(black < kWidth * kHeight / 20);
    const CloudFrame moved = room.draw(frames, view_at(0, 0.01, 0), *executor);
    CHECK(moved.report.filled > 0);
    CHECK(moved.report.reused + moved.report.filled < moved.report.pixels);
    std::size_t filled = moved.report.filled;
    for (int i = 0; i < 3; ++i) {
        const CloudFrame next = room.draw(frames, view_at(0, 0.01, 0), *executor);
        CHECK(next.report.filled < filled);
        filled = next.report.filled;
    }
}

TEST_CASE("cloud: of one traced pixel in sixteen a frame's edges and most of its light are right" *
          one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const View view = view_at(0, 0, 0);
    const Camera camera(view);
    WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 1);
    SceneCaster caster(room.scene.tracer, room.visibility, camera, frame_options(), contexts,
                       room.stop);
    CloudOptions options;
    options.budget = 1;
    CloudRegion region({0, 0, kWidth, kHeight}, kWidth, kHeight, options);
    region.begin(camera, {});
    region.project(*executor);
    region.answer(caster, *executor, room.stop);
    TraceList& list = region.to_trace();
    const std::vector<PixelPlace> places = list.places();
    const UncachedPixelTracer tracer(caster, 0.1, CloudRegion::Clock::time_point::max());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i].x % 4 != 0 || places[i].y % 4 != 0) continue;
        tracer.trace(std::span(places).subspan(i, 1), 0, *executor, room.stop,
                     [&](std::size_t, std::span<const TracedPixelResult> traced) {
                         list.record(i, traced);
                     });
    }
    region.show(false);
    std::vector<Rgb> filled = region.frame().radiance;  // from whatever is around
    fill_gaps(kWidth, kHeight, filled, region.frame().known, SerialTaskRunner());
    region.infer(caster, *executor, room.stop, CloudRegion::Clock::time_point::max());
    const CloudReport& report = region.frame().report;
    CHECK(report.filled == report.pixels - report.pixels / 16);
    CHECK(report.inferred > 0.97 * report.filled);
    const std::vector<TracedPixel> truth = room.truth(view);
    std::size_t near = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const float is = region.frame().distance[i];
        const PixelVisibility& sees = truth[i].visibility;
        // A floor's own distance stands for what it reflects.
        if (std::abs(is - truth[i].distance) < 0.001f * truth[i].distance ||
            std::abs(is - sees.ahead.distance) < 0.001f * sees.ahead.distance)
            ++near;
    }
    CHECK(near > 0.99 * report.pixels);
    // What is left is noise of the lamp's samples, and what the floor reflects.
    const std::size_t off = off_by_a_tenth(region.frame().radiance, truth);
    CHECK(off < report.pixels / 5);
    CHECK(off < 0.8 * static_cast<double>(off_by_a_tenth(filled, truth)));
}

TEST_CASE("cloud: a view that stands still becomes the traced picture, then a smoother one" *
          one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudOptions options;
    options.refine = 0.25;
    CloudFrames frames(kWidth, kHeight, options);
    for (int i = 0; i < 4; ++i) (void)room.draw(frames, view_of("forward", i), *executor);
    const View view = view_of("forward", 4);
    const std::vector<TracedPixel> truth = room.truth(view);
    const auto wrong = [&](const CloudFrame& frame) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            count += frame.radiance[i] == truth[i].radiance ? 0 : 1;
        return count;
    };
    std::size_t last = wrong(room.draw(frames, view, *executor));
    CHECK(last > truth.size() / 2);
    for (int i = 0; i < 4; ++i) {
        const CloudFrame frame = room.draw(frames, view, *executor);
        const std::size_t now = wrong(frame);
        CHECK(now <= last);
        last = now;
        CHECK(frame.report.uncached[static_cast<std::size_t>(TraceCause::refined)] <=
              truth.size() / 4 + 1);
    }
    CHECK(last == 0);
    const CloudFrame smoother = room.draw(frames, view, *executor);
    CHECK(smoother.report.uncached[static_cast<std::size_t>(TraceCause::refined)] > 100);
    CHECK(wrong(smoother) > 100);
    const CloudFrame on = room.draw(frames, view_of("forward", 5), *executor);  // and on it goes
    CHECK(on.report.reused > on.report.pixels * 8 / 10);
}

TEST_CASE("cloud: audited errors are told, and too large ones tighten reuse" * one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudOptions options;
    options.audit = 0.1;
    options.audit_limit = 1e-6;  // more than any reuse can hold
    CloudFrames frames(kWidth, kHeight, options);
    std::size_t errors = 0, floors = 0;
    double tightness = 1;
    for (int i = 0; i < 6; ++i) {
        const CloudFrame frame = room.draw(frames, view_of("sideways", i), *executor);
        errors += frame.report.audit_errors.size();
        floors += frame.report.audit_floors.size();
        CHECK(frame.report.tightness <= tightness);
        tightness = frame.report.tightness;
    }
    CHECK(errors > 1000);
    CHECK(floors > errors / 6);
    CHECK(floors < errors / 3);
}

TEST_CASE("cloud: a long walk at random neither grows nor fails" * one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    CloudOptions options;
    options.limit = 2;
    CloudFrames frames(kWidth, kHeight, options);
    RandomStream random(11);
    double forward = 2, aside = 0, turned = 0;
    for (int i = 0; i < 30; ++i) {
        forward = std::clamp(forward + 0.3 * (random.next() - 0.5), 0.5, 6.0);
        aside = std::clamp(aside + 0.3 * (random.next() - 0.5), -2.0, 2.0);
        turned += 0.2 * (random.next() - 0.5);
        const CloudFrame frame = room.draw(frames, view_at(forward, aside, turned), *executor);
        CHECK(frame.complete);
        CHECK(frames.points().size() <= std::size_t{2} * kWidth * kHeight);
        CHECK(frame.report.points <= frames.points().size());
    }
}
