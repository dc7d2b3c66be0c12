// Several samples a pixel (--samples): laws of the filtered picture.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "parallel/frame.h"
#include "tests/one_thread.h"
#include "tests/parallel/room_view.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::about_numbers;
using lightwalk::test::room_view;
using lightwalk::test::Silence;
using lightwalk::test::TestScene;

namespace {

/// A glowing square of 1 m² on nothing, for a parallel view.
const std::string kSquare =
    "void glow bright 0 0 4 1 1 1 0\n"
    "bright polygon square 0 0 12  -.5 5 -.5  .5 5 -.5  .5 5 .5  -.5 5 .5\n";

/// A floor and a rough, shiny ball under a lamp: noise of several kinds.
const std::string kSampledRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 0 0
void metal ball 0 0 5 .9 .8 .7 .8 .1
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
ball sphere shiny 0 0 4 0 0 1 1
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

RenderOptions noisy_samples() {
    RenderOptions options;
    options.source_jitter = 0.9;
    options.virtual_source_pretest = 0;
    return options;
}

View parallel_view(double size) {
    View view;
    view.type = 'l';
    view.horizontal = view.vertical = size;
    return view;
}

FrameOptions sample_options(int width, int height, int samples, std::uint64_t seed = 0) {
    FrameOptions options;
    options.width = width;
    options.height = height;
    options.pixels.spacing = 1;
    options.pixels.samples = samples;
    options.seed = seed;
    return options;
}

Frame render_samples(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                     Executor& executor) {
    Silence warnings;
    WorkerContexts contexts(tracer, warnings, executor.concurrency());
    return render_frame(tracer, camera, options, executor, contexts, StopFlag(),
                        [](const FrameProgress&) {});
}

Frame render_samples(const Tracer& tracer, const View& view, const FrameOptions& options) {
    return render_samples(tracer, Camera(view), options, *make_executor(ExecutorKind::serial, 1));
}

TileMask all_tiles(const FrameOptions& options) {
    TileMask tiles(options.width, options.height);
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) tiles.set(tile);
    return tiles;
}

constexpr int kEdgeSize = 16;  // of edge_response() [pixels]

double green(const Frame& frame, std::size_t i) {
    return static_cast<double>(frame.radiance[i].g);
}

double total(const Frame& frame) {
    double sum = 0;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) sum += green(frame, i);
    return sum;
}

}  // namespace

TEST_CASE("with several samples the picture does not depend on executor, threads or blocks") {
    const TestScene scene(kSampledRoom, noisy_samples());
    const Camera camera(room_view());
    for (const auto& [spacing, filter] : std::vector<std::pair<int, PixelFilter>>{
             {1, PixelFilter::gaussian}, {1, PixelFilter::mitchell}, {4, PixelFilter::gaussian}}) {
        FrameOptions options = sample_options(61, 47, 5);
        options.pixels.spacing = spacing;
        options.pixels.filter = filter;
        const Frame expected =
            render_samples(scene.tracer, camera, options, *make_executor(ExecutorKind::serial, 1));
        for (const int workers : {1, 2, 7}) {
            const Frame frame = render_samples(scene.tracer, camera, options,
                                               *make_executor(kDefaultExecutor, workers));
            CHECK(std::memcmp(frame.radiance.data(), expected.radiance.data(),
                              expected.radiance.size() * sizeof(Rgb)) == 0);
            CHECK(frame.distance == expected.distance);
            CHECK(frame.rays.total() == expected.rays.total());
        }
    }
}

TEST_CASE("samples keep the light: a square's pixels add up to its area" * about_numbers) {
    const TestScene scene(kSquare);
    constexpr int kSize = 24;
    const double pixel = 1.6 / kSize;
    const double area = 1 / (pixel * pixel);
    for (const auto& [samples, filter] : std::vector<std::pair<int, PixelFilter>>{
             {1, PixelFilter::gaussian}, {8, PixelFilter::gaussian}, {8, PixelFilter::mitchell}}) {
        CAPTURE(samples);
        double sum = 0;
        constexpr int kSeeds = 60;
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            FrameOptions options = sample_options(kSize, kSize, samples, seed);
            options.pixels.filter = filter;
            const TileMask tiles = all_tiles(options);  // or what is below zero would be cut off
            if (samples > 1) options.tiles = &tiles;
            options.pixels.jitter = 1;  // with one sample: anywhere in its pixel
            sum += total(render_samples(scene.tracer, parallel_view(1.6), options));
        }
        // Some two pixels on either side of the outline are uncertain, each by 1/2 at most.
        const double uncertain = 4 * 4 / pixel;
        const double error = 0.5 * std::sqrt(uncertain / samples / kSeeds);
        CHECK(std::abs(sum / kSeeds - area) < 4 * error);
        CHECK(4 * error < 0.02 * area);  // or the test could not tell
    }
}

/// Rows of pixels that are alike, .3 pixels beside a straight edge; by distance to it [pixels].
std::vector<double> edge_response(PixelFilter filter, int samples, bool cut_off) {
    const TestScene scene(kSquare);
    const double width = 0.8;  // [m]; the edge at .5 m lies in the right half
    View view = parallel_view(width);
    view.position = {0.5 - 0.3 * width / kEdgeSize, 0, 0};  // 0.3 pixels left of it
    view.vertical = 0.4;  // nowhere near the upper and lower edges
    FrameOptions options = sample_options(kEdgeSize, kEdgeSize, samples);
    options.pixels.filter = filter;
    const TileMask tiles = all_tiles(options);
    if (!cut_off) options.tiles = &tiles;
    const Frame frame = render_samples(scene.tracer, view, options);
    std::vector<double> means(kEdgeSize);
    for (std::size_t i = 0; i < frame.radiance.size(); ++i)
        means[i % kEdgeSize] += green(frame, i) / kEdgeSize;
    return means;
}

/// Share of Mitchell's filter that is left of x: the integral of its two cubics.
double mitchell_left_of(double x) {
    const double d = std::min(std::abs(x), 2.0);
    const auto inner = [](double t) {
        return (7 * t * t * t * t / 4 - 4 * t * t * t + 16 * t / 3) / 6;
    };
    const auto outer = [](double t) {
        return (-7 * t * t * t * t / 12 + 4 * t * t * t - 10 * t * t + 32 * t / 3) / 6;
    };
    const double half = d < 1 ? inner(d) : inner(1) + outer(d) - outer(1);
    return x > 0 ? .5 + half : .5 - half;
}

TEST_CASE("a straight edge gets what the filter sees of it") {
    constexpr int kSamples = 64;
    for (const PixelFilter filter : {PixelFilter::gaussian, PixelFilter::mitchell}) {
        const bool gaussian = filter == PixelFilter::gaussian;
        const std::vector<double> found = edge_response(filter, kSamples, false);
        double least = 1;
        for (int x = 0; x < kEdgeSize; ++x) {
            CAPTURE(x);
            const double to_edge = kEdgeSize / 2 + 0.3 - (x + 0.5);  // [pixels]
            const double coverage =
                gaussian ? 0.5 * (1 + std::erf(to_edge / 0.6)) : mitchell_left_of(to_edge);
            // Independent samples would have this standard error at most.
            const double error = std::sqrt(std::max(std::abs(coverage * (1 - coverage)), .02) /
                                           (kSamples * kEdgeSize));
            const double value = found[static_cast<std::size_t>(x)];
            CHECK(std::abs(value - coverage) < 4 * error + 1e-4);  // tails that no sample meets
            least = std::min(least, value);
        }
        CHECK((least < -.01) == !gaussian);  // beside the edge
    }
}

TEST_CASE("a finished picture has no negative radiance, whatever its filter") {
    const std::vector<double> whole = edge_response(PixelFilter::mitchell, 16, false);
    const std::vector<double> cut = edge_response(PixelFilter::mitchell, 16, true);
    REQUIRE(*std::ranges::min_element(whole) < -.01);
    CHECK(*std::ranges::min_element(cut) >= 0);
    for (std::size_t x = 0; x < cut.size(); ++x)
        if (whole[x] > .1) CHECK(cut[x] == whole[x]);
}

TEST_CASE("16 samples have less than an eighth of the variance of one" * about_numbers) {
    const TestScene scene(kSampledRoom, noisy_samples());
    const auto variance = [&](int samples) {
        constexpr int kSeeds = 24;
        std::vector<double> sum(20 * 15), squares(20 * 15);
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            const Frame frame = render_samples(scene.tracer, room_view(),
                                               sample_options(20, 15, samples, seed + 1));
            for (std::size_t i = 0; i < sum.size(); ++i) {
                sum[i] += green(frame, i);
                squares[i] += green(frame, i) * green(frame, i);
            }
        }
        double result = 0;
        for (std::size_t i = 0; i < sum.size(); ++i)
            result += squares[i] / kSeeds - sum[i] / kSeeds * (sum[i] / kSeeds);
        return result;
    };
    CHECK(variance(16) < variance(1) / 8);
}

TEST_CASE("small sources are found by the samples, and count once" * about_numbers) {
    // 0.2 x 0.2 pixels of a lamp.
    const TestScene scene(
        "void light lamp 0 0 3 100 100 100\n"
        "lamp polygon speck 0 0 12  .0041 5 .0041  .0061 5 .0041  .0061 5 .0061  .0041 5 .0061\n");
    const double pixel = 0.16 / 16;
    const double expected = 100 * 0.002 * 0.002 / (pixel * pixel);
    constexpr int kSeeds = 60;
    constexpr int kSamples = 64;
    double sum = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
        sum += total(render_samples(scene.tracer, parallel_view(0.16),
                                    sample_options(16, 16, kSamples, seed)));
    const double hits = kSeeds * kSamples * expected / 100;
    CHECK(std::abs(sum / kSeeds - expected) < 4 * expected / std::sqrt(hits));
}

TEST_CASE("with several samples a window is that part of the picture, layers and hits as well") {
    const TestScene scene(kSampledRoom, noisy_samples());
    const Camera camera(room_view());
    FrameOptions options = sample_options(90, 70, 6);
    options.hits = true;
    SUBCASE("Gaussian") {}
    SUBCASE("Mitchell's filter") {
        options.pixels.filter = PixelFilter::mitchell;
    }
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const Frame whole = render_samples(scene.tracer, camera, options, *executor);
    options.window = PixelRectangle{13, 5, 58, 69};
    const Frame part = render_samples(scene.tracer, camera, options, *executor);
    REQUIRE(part.width == 45);
    for (int row = 0; row < part.height; ++row) {
        for (int x = 0; x < part.width; ++x) {
            const auto of_part = static_cast<std::size_t>(row * part.width + x);
            const auto of_whole = static_cast<std::size_t>((row + 1) * 90 + x + 13);
            REQUIRE(part.radiance[of_part] == whole.radiance[of_whole]);
            REQUIRE(part.distance[of_part] == whole.distance[of_whole]);
            REQUIRE(part.hits[of_part] == whole.hits[of_whole]);
        }
    }
}

TEST_CASE("what is bright all over is so in every pixel, to rounding, whatever the samples") {
    const TestScene scene(
        "void glow even 0 0 4 .7 .5 .3 0\n"
        "even source all 0 0 4 0 0 1 360\n");
    for (const PixelFilter filter : {PixelFilter::gaussian, PixelFilter::mitchell}) {
        for (const int samples : {2, 3, 4, 9, 16}) {
            FrameOptions options = sample_options(40, 35, samples);
            options.pixels.filter = filter;
            const Frame frame = render_samples(scene.tracer, room_view(), options);
            for (std::size_t i = 0; i < frame.radiance.size(); ++i)
                REQUIRE(green(frame, i) == doctest::Approx(.5).epsilon(1e-5));
        }
    }
}

/// Mean and variance of the pixels of many pictures with shared samples, or with pixels' own.
struct Seeds {
    double mean = 0;
    double error = 0;  ///< of the mean
    double noise = 0;  ///< mean variance of a pixel
};

Seeds over_seeds(const TestScene& scene, const View& view, int samples, bool shared) {
    constexpr int kSeeds = 40;
    constexpr int kWidth = 20, kHeight = 15;
    std::vector<double> sum(kWidth * kHeight), squares(kWidth * kHeight);
    double means = 0, mean_squares = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        FrameOptions options = sample_options(kWidth, kHeight, samples, seed + 1);
        if (!shared) {  // where pixels may be interpolated, though all are traced
            options.pixels.spacing = 2;
            options.pixels.threshold = 0;
        }
        const Frame frame = render_samples(scene.tracer, view, options);
        const double mean = total(frame) / (kWidth * kHeight);
        means += mean;
        mean_squares += mean * mean;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += green(frame, i);
            squares[i] += green(frame, i) * green(frame, i);
        }
    }
    Seeds result{means / kSeeds, 0, 0};
    result.error = std::sqrt((mean_squares / kSeeds - result.mean * result.mean) / (kSeeds - 1));
    for (std::size_t i = 0; i < sum.size(); ++i)
        result.noise += (squares[i] / kSeeds - sum[i] / kSeeds * (sum[i] / kSeeds)) /
                        static_cast<double>(sum.size());
    return result;
}

TEST_CASE("shared samples show the same light as pixels' own, with far less noise" *
          about_numbers) {
    RenderOptions options;
    options.source_jitter = 1;
    std::string room;
    View view = room_view();
    double gain = 4;  // at least
    SUBCASE("a lamp behind a grid: strata of its area") {
        options.source_subdivision = 0;
        room =
            "void plastic white 0 0 5 .6 .6 .6 0 0\n"
            "void light lamp 0 0 3 20 20 20\n"
            "white polygon ground 0 0 12  -19 -19 0  19 -19 0  19 19 0  -19 19 0\n"
            "lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5\n"
            "white polygon shade 0 0 12  -.6 -9 3  -.1 -9 3  -.1 9 3  -.6 9 3\n"
            "white polygon shade2 0 0 12  .1 -9 3  .5 -9 3  .5 9 3  .1 9 3\n";
        view.type = 'l';
        view.position = {0, 0, 2};
        view.direction = {0, 0, -1};
        view.up = {0, 1, 0};
        view.horizontal = view.vertical = 3;
    }
    SUBCASE("a rough ball before it: strata of the lobe") {
        room =
            "void metal rough 0 0 5 .9 .9 .9 .9 .15\n"
            "void glow sky 0 0 4 2 2 2 0\n"
            "sky source above 0 0 4 0 0 1 120\n"
            "rough polygon wall 0 0 12  -9 9 -9  9 9 -9  9 9 9  -9 9 9\n";
        view = View{};
        view.direction = {0, 1, .2};
        gain = 3;
    }
    const TestScene scene(room, options);
    for (const int samples : {4, 9, 16}) {
        CAPTURE(samples);
        const Seeds shared = over_seeds(scene, view, samples, true);
        const Seeds own = over_seeds(scene, view, samples, false);
        // Both see through the same filter, which one of them ends where .4 % of it are left.
        const double rest = .001 * own.mean;
        CHECK(std::abs(shared.mean - own.mean) < 4 * std::hypot(shared.error, own.error) + rest);
        CHECK(own.error < .02 * own.mean);  // or the test could not tell
        CHECK(shared.noise * gain < own.noise);
    }
}

TEST_CASE("distance is that of the ray nearest to the pixel's centre, of the pixel's own") {
    const TestScene scene(kSampledRoom);
    const Camera camera(room_view());
    const FrameOptions options = sample_options(20, 15, 4);
    const Frame frame = render_samples(scene.tracer, room_view(), options);
    const PixelRays rays(camera, nullptr, 20, 15, options.pixels, 0, 1, SampleUse::shared);
    TestScene again(kSampledRoom);
    for (int row = 0; row < 15; ++row) {
        for (int x = 0; x < 20; ++x) {
            const auto far = [&](int sample) {
                const PixelRays::Place at = rays.place(x, 14 - row, sample);
                return std::hypot(at.h * 20 - x - 0.5, at.v * 15 - (14 - row) - 0.5);
            };
            int nearest = 0;
            for (int sample = 1; sample < 4; ++sample)
                if (far(sample) < far(nearest)) nearest = sample;
            const PixelRay pixel = rays(x, 14 - row, nearest);
            REQUIRE(pixel.ray);
            const Ray ray = again.trace(pixel.ray->origin, pixel.ray->direction);
            CHECK(frame.distance[static_cast<std::size_t>(row * 20 + x)] ==
                  doctest::Approx(ray.effective_distance()).epsilon(1e-6));
        }
    }
}
