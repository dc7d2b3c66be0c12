#include "parallel/frame.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/light/small_sources.h"
#include "tests/one_thread.h"
#include "tests/parallel/room_view.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::one_thread;
using lightwalk::test::room_view;
using lightwalk::test::Silence;
using lightwalk::test::TestScene;

namespace {

/// A floor and a rough, shiny ball under a square lamp and a sky: textures of all kinds of sampling
/// noise.
const std::string kFrameRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 0 0
void metal ball 0 0 5 .9 .8 .7 .8 .1
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
void glow sky 0 0 4 1 1 2 0
sky source dome 0 0 4 0 0 1 180
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
ball sphere shiny 0 0 4 0 0 1 1
pane polygon window 0 0 12  2 -2 0  2 2 0  2 2 3  2 -2 3
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

RenderOptions noisy_frame() {
    RenderOptions options;
    options.source_jitter = 0.9;
    options.virtual_source_pretest = 0;
    return options;
}

FrameOptions options_of(int width, int height, int spacing, double jitter = 0) {
    FrameOptions options;
    options.width = width;
    options.height = height;
    options.pixels.spacing = spacing;
    options.pixels.jitter = jitter;
    return options;
}

Frame render(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
             Executor& executor) {
    Silence warnings;
    WorkerContexts contexts(tracer, warnings, executor.concurrency());
    return render_frame(tracer, camera, options, executor, contexts, StopFlag(),
                        [](const FrameProgress&) {});
}

Frame render(const Tracer& tracer, const View& view, const FrameOptions& options) {
    return render(tracer, Camera(view), options, *make_executor(ExecutorKind::serial, 1));
}

bool same_bytes(const Frame& a, const Frame& b) {
    return a.radiance.size() == b.radiance.size() &&
           std::memcmp(a.radiance.data(), b.radiance.data(), a.radiance.size() * sizeof(Rgb)) ==
               0 &&
           std::memcmp(a.distance.data(), b.distance.data(), a.distance.size() * sizeof(float)) ==
               0;
}

}  // namespace

TEST_CASE("the picture does not depend on executor, threads or blocks, whatever the spacing") {
    const TestScene scene(kFrameRoom, noisy_frame());
    const Camera camera(room_view());
    for (const int spacing : {1, 4, 7}) {
        FrameOptions options = options_of(61, 47, spacing, 0.67);
        options.use_distances = spacing == 7;
        const Frame expected =
            render(scene.tracer, camera, options, *make_executor(ExecutorKind::serial, 1));
        CHECK(expected.complete);
        for (const ExecutorKind kind : {ExecutorKind::threads, kDefaultExecutor}) {
            for (const int workers : {1, 2, 7}) {
                CAPTURE(spacing);
                CAPTURE(workers);
                const Frame frame =
                    render(scene.tracer, camera, options, *make_executor(kind, workers));
                CHECK(same_bytes(frame, expected));
                CHECK(frame.rays.total() == expected.rays.total());
            }
        }
    }
}

TEST_CASE("another seed draws other numbers, the same seed the same" * one_thread) {
    const TestScene scene(kFrameRoom, noisy_frame());
    FrameOptions options = options_of(32, 24, 1, 0.67);
    const Frame a = render(scene.tracer, room_view(), options);
    const Frame b = render(scene.tracer, room_view(), options);
    options.seed = 1;
    const Frame c = render(scene.tracer, room_view(), options);
    CHECK(same_bytes(a, b));
    CHECK_FALSE(same_bytes(a, c));
}

TEST_CASE("with spacing 1 each pixel is its own ray, rows from the top") {
    TestScene scene(kFrameRoom);
    const Camera camera(room_view());
    const int width = 20;
    const int height = 15;
    const Frame frame = render(scene.tracer, room_view(), options_of(width, height, 1));
    for (int row = 0; row < height; ++row) {
        for (int x = 0; x < width; ++x) {
            const auto view_ray = camera.ray((x + 0.5) / width, (height - 1 - row + 0.5) / height);
            REQUIRE(view_ray);
            const Ray ray = scene.trace(view_ray->origin, view_ray->direction);
            const auto i = static_cast<std::size_t>(row * width + x);
            CHECK(frame.radiance[i] == ray.value);
            CHECK(frame.distance[i] == static_cast<float>(ray.effective_distance()));
        }
    }
    CHECK(frame.rays.primary == static_cast<std::uint64_t>(width) * height);
}

TEST_CASE("wider spacing traces fewer rays and stays near the full picture" * one_thread) {
    const TestScene scene(kFrameRoom);
    const Frame full = render(scene.tracer, room_view(), options_of(160, 120, 1));
    const Frame sparse = render(scene.tracer, room_view(), options_of(160, 120, 4));
    CHECK(sparse.rays.primary < full.rays.primary / 2);
    double difference = 0;
    double sum = 0;
    for (std::size_t i = 0; i < full.radiance.size(); ++i) {
        difference += std::abs(static_cast<double>(full.radiance[i].g) -
                               static_cast<double>(sparse.radiance[i].g));
        sum += static_cast<double>(full.radiance[i].g);
    }
    CHECK(difference < 0.05 * sum);  // -pt: corners closer than this are interpolated
}

TEST_CASE(
    "outside the view's domain pixels are black at distance 0, beyond the aft plane at distance "
    "1e10") {
    const TestScene scene("void glow g 0 0 4 1 1 1 0\ng source all 0 0 4 0 0 1 360\n");
    View fisheye;
    fisheye.type = 'h';
    fisheye.horizontal = fisheye.vertical = 180;
    Frame frame = render(scene.tracer, fisheye, options_of(16, 16, 1));
    CHECK(frame.radiance[0] == Rgb(0, 0, 0));
    CHECK(frame.distance[0] == 0);
    CHECK(frame.radiance[8 * 16 + 8] == Rgb(1, 1, 1));
    CHECK(frame.distance[8 * 16 + 8] == 1e10f);
    fisheye.aft = 5;
    frame = render(scene.tracer, fisheye, options_of(16, 16, 1));
    CHECK(frame.radiance[8 * 16 + 8] == Rgb(0, 0, 0));
    CHECK(frame.distance[8 * 16 + 8] == 1e10f);
}

TEST_CASE(
    "a lamp smaller than a pixel is drawn with its coverage, not with -dv- or through a lens" *
    one_thread) {
    // A square lamp of 2 mm at 1 m in a picture of 16 pixels over 0.16 m: a fifth of a pixel wide,
    // off centre.
    const std::string text = R"(
void light lamp 0 0 3 100 100 100
lamp polygon small 0 0 12  .0011 1 .0011  .0031 1 .0011  .0031 1 .0031  .0011 1 .0031
)";
    View view;
    view.type = 'l';
    view.horizontal = view.vertical = 0.16;
    const double pixel = 0.16 / 16;
    const double expected = 100 * 0.002 * 0.002 / (pixel * pixel);
    const auto total = [](const Frame& frame) {
        double sum = 0;
        for (const Rgb& c : frame.radiance) sum += static_cast<double>(c.g);
        return sum;
    };
    for (const int spacing : {1, 4, 16}) {
        CAPTURE(spacing);
        const TestScene scene(text);
        CHECK(total(render(scene.tracer, view, options_of(16, 16, spacing))) ==
              doctest::Approx(expected).epsilon(1e-4));
    }
    RenderOptions invisible = TestScene::exact();
    invisible.sources_visible = false;
    const TestScene dark(text, invisible);
    CHECK(total(render(dark.tracer, view, options_of(16, 16, 1))) == 0);
    FrameOptions lens = options_of(16, 16, 1);
    lens.pixels.aperture = 1e-5;
    const TestScene scene(text);
    CHECK(total(render(scene.tracer, view, lens)) == 0);
}

TEST_CASE("a requested stop ends the frame early and marks it") {
    const TestScene scene(kFrameRoom, noisy_frame());
    const Camera camera(room_view());
    for (const ExecutorKind kind :
         {ExecutorKind::serial, ExecutorKind::threads, kDefaultExecutor}) {
        Silence warnings;
        StopFlag stop;
        const std::unique_ptr<Executor> executor = make_executor(kind, 2);
        WorkerContexts contexts(scene.tracer, warnings, executor->concurrency());
        const Frame frame =
            render_frame(scene.tracer, camera, options_of(512, 512, 1), *executor, contexts, stop,
                         [&](const FrameProgress&) { stop.request(); });
        CHECK_FALSE(frame.complete);
        CHECK(frame.rays.primary < 512 * 512 / 2);
    }
}

TEST_CASE("progress grows to all pixels and counts the rays") {
    const TestScene scene(kFrameRoom);
    const Camera camera(room_view());
    Silence warnings;
    double last = 0;
    std::uint64_t rays = 0;
    WorkerContexts contexts(scene.tracer, warnings, 1);
    const Frame frame = render_frame(scene.tracer, camera, options_of(64, 64, 1),
                                     *make_executor(ExecutorKind::serial, 1), contexts, StopFlag(),
                                     [&](const FrameProgress& progress) {
                                         CHECK(progress.done > last);
                                         CHECK(progress.rays >= rays);
                                         last = progress.done;
                                         rays = progress.rays;
                                     });
    CHECK(last == 1);
    CHECK(rays == frame.rays.total());
}
