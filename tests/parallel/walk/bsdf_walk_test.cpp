// Walks through rooms with BSDF data in their windows: what frames reuse must be what is to be
// seen.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/scene_caster.h"
#include "tests/core/material/bsdf_files.h"
#include "tests/one_thread.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kWide = 96, kHigh = 72, kSteps = 6;

/// A room with a window of material m that shows posts in the sun behind it.
const std::string kRoomWithWindow = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .6 .1 .1 0 0
void light lamp 0 0 3 30 30 30
void light sun_light 0 0 3 2e4 2e4 2e4
sun_light source sun 0 0 4 .3 -.5 1 2
grey polygon floor 0 0 12  -3 -3 0  3 -3 0  3 9 0  -3 9 0
grey polygon left 0 0 12  -3 -3 0  -3 4 0  -3 4 3  -3 -3 3
red polygon right 0 0 12  3 4 0  3 -3 0  3 -3 3  3 4 3
grey polygon ceiling 0 0 12  -3 4 3  3 4 3  3 -3 3  -3 -3 3
grey polygon beside 0 0 12  -3 4 0  -1 4 0  -1 4 3  -3 4 3
grey polygon beyond 0 0 12  1 4 0  3 4 0  3 4 3  1 4 3
m polygon window 0 0 12  -1 4 0  1 4 0  1 4 3  -1 4 3
red cylinder post1 0 0 7  -.5 6 0  -.5 6 3  .15
grey cylinder post2 0 0 7  .4 7 0  .4 7 3  .2
lamp polygon panel 0 0 12  -.5 1 2.99  -.5 2 2.99  .5 2 2.99  .5 1 2.99
)";

View view_at_step(const std::string& walk, int step) {
    const double pace = 0.05 * step, turn = walk == "turn" ? 0.02 * step : 0;
    View view;
    view.position = {walk == "sideways" ? pace : 0.1, -1 + (walk == "forward" ? pace : 0), 1.5};
    view.direction = {std::sin(turn), std::cos(turn), -0.05};
    view.horizontal = 60;
    view.vertical = 46.8;
    return view;
}

FrameOptions small_frames() {
    FrameOptions options;
    options.width = kWide;
    options.height = kHigh;
    options.pixels.spacing = 1;
    return options;
}

/// Pixels whose brightness is off by more than a tenth.
std::size_t count_off(const std::vector<Rgb>& values, const std::vector<Rgb>& truth) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        if (std::abs(brightness(values[i]) - brightness(truth[i])) > 0.1f * brightness(truth[i]))
            ++off;
    return off;
}

/// A scene whose frames are drawn, and traced.
class Walk {
  public:
    explicit Walk(const std::string& material)
        : scene_(material + kRoomWithWindow, TestScene::exact(),
                 with_file(bsdf_of(quarter(0.1 / kPi, 0.5), quarter(0.3 / kPi)))),
          visibility_(scene_.tracer),
          contexts_(scene_.tracer, scene_.warnings, 1),
          executor_(make_executor(ExecutorKind::serial, 1)) {}

    CloudFrame draw(CloudFrames& frames, const View& view) {
        SceneCaster caster = caster_of(view);
        return frames.draw(caster.camera(), caster, *executor_, stop_);
    }
    std::vector<Rgb> truth(const View& view) {
        SceneCaster caster = caster_of(view);
        std::vector<PixelPlace> places;
        for (int y = 0; y < kHigh; ++y)
            for (int x = 0; x < kWide; ++x) places.push_back({x, y});
        std::vector<TracedPixel> pixels(places.size());
        caster.trace(places, pixels, 0, 0);
        std::vector<Rgb> radiance;
        for (const TracedPixel& pixel : pixels) radiance.push_back(pixel.radiance);
        return radiance;
    }

  private:
    SceneCaster caster_of(const View& view) {
        return {scene_.tracer, visibility_, Camera(view), small_frames(), contexts_, stop_};
    }

    TestScene scene_;
    VisibilityProbe visibility_;
    WorkerContexts contexts_;
    std::unique_ptr<Executor> executor_;
    StopFlag stop_;
};

}  // namespace

TEST_CASE("cloud: windows of BSDF data are true in motion, and what lies behind a peak is reused" *
          one_thread) {
    for (const bool peak : {false, true}) {
        CAPTURE(peak);
        Walk of_material(peak ? "void aBSDF m 5 a.xml 0 0 1 . 0 0\n"
                              : "void BSDF m 6 0 a.xml 0 0 1 . 0 0\n");
        for (const std::string walk : {"turn", "forward", "sideways"}) {
            CAPTURE(walk);
            CloudFrames frames(kWide, kHigh, {});
            std::size_t off = 0, floor = 0, reused = 0;
            for (int i = 0; i < kSteps; ++i) {
                View view = view_at_step(walk, i);
                const CloudFrame frame = of_material.draw(frames, view);
                const std::vector<Rgb> truth = of_material.truth(view);
                view.shift = 0.5 / kWide;
                view.lift = 0.5 / kHigh;
                if (i == 0) continue;
                off += count_off(frame.radiance, truth);
                floor += count_off(of_material.truth(view), truth);
                reused += frame.report.reused;
            }
            const auto share = [](std::size_t count) {
                return static_cast<double>(count) / (double{kWide} * kHigh * (kSteps - 1));
            };
            MESSAGE(walk << ": reused " << share(reused) << ", off " << share(off) << " (floor "
                         << share(floor) << ")");
            CHECK(share(off) < share(floor) + 0.01);
            CHECK(share(reused) > (peak ? 0.85 : 0.6));
        }
    }
}
