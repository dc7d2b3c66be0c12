// Pictures that get samples until their error is small enough (--error, --time).
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "parallel/adaptive_picture.h"
#include "tests/one_thread.h"
#include "tests/parallel/room_view.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::one_thread;
using lightwalk::test::room_view;
using lightwalk::test::Silence;
using lightwalk::test::TestScene;

namespace {

constexpr int kWidth = 70, kHeight = 45;  // no multiples of a tile

/// Stands for a picture whose left half is five times as noisy as its right one.
class NoisyPicture {
  public:
    explicit NoisyPicture(std::uint64_t seed) : random_(seed) {}

    static double truth(int x, int row) { return 1 + 0.5 * std::sin(0.3 * x + 0.2 * row); }
    static double noise(int x) { return x < kWidth / 2 ? 0.5 : 0.1; }  ///< relative, of one sample

    Frame draw(const SamplePass& pass) {
        Frame frame;
        frame.width = kWidth;
        frame.height = kHeight;
        frame.radiance.resize(kWidth * kHeight);
        frame.distance.assign(kWidth * kHeight, 3);
        frame.groups.assign(1, std::vector<Rgb>(kWidth * kHeight));
        std::normal_distribution<double> normal;
        for (int row = 0; row < kHeight; ++row) {
            for (int x = 0; x < kWidth; ++x) {
                if (!pass.tiles[pass.tiles.tile(x, kHeight - 1 - row)]) continue;
                const double off = noise(x) * normal(random_) / std::sqrt(pass.samples);
                const auto at = static_cast<std::size_t>(row * kWidth + x);
                frame.radiance[at] = Rgb::grey(static_cast<float>(truth(x, row) * (1 + off)));
                frame.groups[0][at] = frame.radiance[at] * 0.25F;
                ++traced[at];
            }
        }
        return frame;
    }

    std::vector<int> traced = std::vector<int>(kWidth * kHeight);  ///< passes, by pixel

  private:
    std::mt19937_64 random_;
};

/// Share of the pixels whose luminance is within `error` of the truth.
double share_within(const Frame& frame, double error) {
    int within = 0;
    for (int row = 0; row < kHeight; ++row) {
        for (int x = 0; x < kWidth; ++x) {
            const auto at = static_cast<std::size_t>(row * kWidth + x);
            const double truth = NoisyPicture::truth(x, row);
            const auto found = static_cast<double>(brightness(frame.radiance[at]));
            if (std::abs(found - truth) <= error * truth) ++within;
        }
    }
    return within / double{kWidth * kHeight};
}

}  // namespace

TEST_CASE("adaptive pictures: 95 % of the pixels are within the error that was asked for") {
    for (const double error : {.2, .1, .05}) {
        CAPTURE(error);
        double within = 0;
        constexpr int kSeeds = 12;
        for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
            NoisyPicture picture(seed);
            AdaptivePicture adaptive(kWidth, kHeight, 4, seed, {error, 0});
            double done = 0;
            while (const auto pass = adaptive.next(0)) {
                adaptive.add(*pass, picture.draw(*pass));
                CHECK(adaptive.done(0) >= done);
                done = adaptive.done(0);
            }
            CHECK(adaptive.reached());
            REQUIRE(adaptive.error());
            CHECK(*adaptive.error() <= error);
            CHECK(*adaptive.error() > .4 * error);  // what is good enough gets no more
            within += share_within(adaptive.finish(), error) / kSeeds;
        }
        // The estimate that stops it is of the same samples, which leaves it a little too good.
        CHECK(within > .94);
    }
}

TEST_CASE("adaptive pictures: samples go where the noise is, and all of them count alike") {
    NoisyPicture picture(5);
    AdaptivePicture adaptive(kWidth, kHeight, 4, 1, {.03, 0});
    double left = 0, right = 0;  // samples
    while (const auto pass = adaptive.next(0)) {
        CHECK(std::has_single_bit(static_cast<unsigned>(pass->samples)));
        for (int x = 0; x < kWidth; ++x)
            if (pass->tiles[pass->tiles.tile(x, 20)])
                (x < kWidth / 2 ? left : right) += pass->samples;
        adaptive.add(*pass, picture.draw(*pass));
    }
    // The least sum of squares has five times as many there; they come in powers of two.
    CHECK(left > 2.5 * right);
    CHECK(left < 12 * right);
    const AdaptivePicture::Samples samples = adaptive.samples();
    CHECK(samples.least >= 4);
    CHECK(samples.most >= 4 * samples.least);
    CHECK(samples.mean > samples.least);
    CHECK(samples.mean < samples.most);
    const Frame frame = adaptive.finish();
    REQUIRE(frame.error.size() == frame.radiance.size());
    double estimated = 0, found = 0;
    for (std::size_t at = 0; at < frame.radiance.size(); ++at) {
        const int x = static_cast<int>(at) % kWidth, row = static_cast<int>(at) / kWidth;
        const double truth = NoisyPicture::truth(x, row);
        estimated += std::pow(static_cast<double>(frame.error[at]), 2);
        found += std::pow(static_cast<double>(brightness(frame.radiance[at])) / truth - 1, 2);
        // A group of a quarter is one of the whole, too: weights are those of the picture.
        REQUIRE(frame.groups[0][at].g == doctest::Approx(frame.radiance[at].g / 4).epsilon(1e-4));
        REQUIRE(frame.distance[at] == 3);
    }
    CHECK(std::sqrt(found / estimated) == doctest::Approx(1).epsilon(.1));
}

TEST_CASE("adaptive pictures: they end when the time is up, or soon before") {
    NoisyPicture picture(9);
    AdaptivePicture adaptive(kWidth, kHeight, 4, 1, {0, 10});
    double seconds = 2;  // of what comes before the first pass
    int passes = 0;
    while (const auto pass = adaptive.next(seconds)) {
        ++passes;
        double samples = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                if (pass->tiles[pass->tiles.tile(x, y)]) samples += pass->samples;
        seconds += samples * 4e-5;
        adaptive.add(*pass, picture.draw(*pass));
    }
    CHECK(passes > 8);
    CHECK(seconds <= 10);
    CHECK(seconds > 8.5);
    CHECK(adaptive.reached());
    CHECK(adaptive.done(10) == 1);
}

TEST_CASE("adaptive pictures: without time for more the first rays of each pixel are traced") {
    NoisyPicture picture(2);
    AdaptivePicture adaptive(kWidth, kHeight, 1, 1, {.001, .5});
    double seconds = 0;
    while (const auto pass = adaptive.next(seconds)) {
        seconds += 1;
        adaptive.add(*pass, picture.draw(*pass));
    }
    CHECK(seconds == 2);
    CHECK_FALSE(adaptive.reached());
    for (const int passes : picture.traced) REQUIRE(passes == 2);
}

TEST_CASE("adaptive pictures: black ones, and those without noise, have no error") {
    for (const float value : {0.F, .5F}) {
        AdaptivePicture adaptive(kWidth, kHeight, 4, 1, {.01, 0});
        int passes = 0;
        while (const auto pass = adaptive.next(0)) {
            Frame frame;
            frame.radiance.assign(kWidth * kHeight, Rgb::grey(value));
            frame.distance.assign(kWidth * kHeight, 1);
            adaptive.add(*pass, frame);
            ++passes;
        }
        CHECK(passes == 2);
        CHECK(adaptive.error() == std::optional<double>(0));
        for (const Rgb& pixel : adaptive.finish().radiance) REQUIRE(pixel == Rgb::grey(value));
    }
}

TEST_CASE("adaptive pictures: what cannot become good ends at the most samples" * one_thread) {
    AdaptivePicture adaptive(8, 8, 4, 1, {.01, 0});
    float value = 1;
    while (const auto pass = adaptive.next(0)) {
        Frame frame;
        frame.radiance.assign(64, Rgb::grey(value = 3 - value));
        frame.distance.assign(64, 1);
        adaptive.add(*pass, frame);
    }
    CHECK_FALSE(adaptive.reached());
    CHECK(adaptive.samples().most >= AdaptivePicture::kMostSamples);
    CHECK(adaptive.samples().most < 4 * AdaptivePicture::kMostSamples);
}

TEST_CASE("tiles of a picture have its bytes, and others are black") {
    RenderOptions light;
    light.source_jitter = 0.9;
    const TestScene scene(
        "void plastic floor 0 0 5 .5 .4 .3 0 0\nvoid light lamp 0 0 3 20 20 20\n"
        "floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\n"
        "lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5\n",
        light);
    const Camera camera(room_view());
    FrameOptions options;
    options.width = 61;
    options.height = 47;
    options.pixels.spacing = 1;
    options.pixels.samples = 4;
    Silence warnings;
    const auto draw = [&](int workers, std::uint64_t& rays) {
        const auto executor = make_executor(kDefaultExecutor, workers);
        WorkerContexts contexts(scene.tracer, warnings, workers);
        const Frame frame = render_frame(scene.tracer, camera, options, *executor, contexts,
                                         StopFlag(), [](const FrameProgress&) {});
        rays = frame.rays.total();
        return frame;
    };
    SUBCASE("Gaussian") {}
    SUBCASE("Mitchell's filter") {
        options.pixels.filter = PixelFilter::mitchell;
    }
    std::uint64_t all = 0, some = 0;
    const Frame whole = draw(1, all);
    TileMask tiles(options.width, options.height);
    for (const std::size_t tile : {std::size_t{0}, std::size_t{7}, std::size_t{10}, std::size_t{11},
                                   std::size_t{25}, tiles.size() - 1})
        tiles.set(tile);
    options.tiles = &tiles;
    for (const int workers : {1, 3}) {
        const Frame part = draw(workers, some);
        std::size_t at = 0;
        for (int y = options.height; y-- > 0;) {
            for (int x = 0; x < options.width; ++x, ++at) {
                const bool wanted = tiles[tiles.tile(x, y)];
                // They are parts of a mean, and may be less than nothing where it may not.
                REQUIRE(positive_part(part.radiance[at]) == (wanted ? whole.radiance[at] : Rgb()));
                if (wanted) REQUIRE(part.distance[at] == whole.distance[at]);
            }
        }
        CHECK(some < all / 4);  // 6 of 48, with what is traced around them
    }
}
