#include "core/view/refine.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include "core/math/random.h"
#include "parallel/blocks.h"
#include "rpict_pattern.h"

using namespace lightwalk;

namespace {

using Image = std::function<PixelValue(int x, int y)>;

struct Refined {
    std::vector<PixelValue> pixels;
    std::vector<int> stored;  ///< how often each pixel was
    std::vector<int> traced;  ///< the same
    std::size_t strays = 0;   ///< pixels traced or stored outside their tile
    [[nodiscard]] const PixelValue& at(int x, int y, int width) const {
        return pixels[static_cast<std::size_t>(y * width + x)];
    }
    [[nodiscard]] long rays() const { return std::accumulate(traced.begin(), traced.end(), 0L); }
};

/// Refine a whole picture, tile by tile, in the order of `make_blocks`.
Refined refine(const Image& image, int width, int height, const RefineOptions& options) {
    Refined result;
    result.pixels.resize(static_cast<std::size_t>(width * height));
    result.stored.resize(result.pixels.size());
    result.traced.resize(result.pixels.size());
    for (const PixelRectangle& tile :
         make_blocks({0, 0, width, height}, refine_tile_side(options.spacing))) {
        const auto count = [&](const PixelPlace& place, std::vector<int>& times) {
            if (!tile.contains(place)) ++result.strays;
            const auto i = static_cast<std::size_t>(place.y * width + place.x);
            ++times[i];
            return i;
        };
        refine_tile(
            tile, options,
            [&](std::span<const PixelPlace> places, std::span<PixelValue> values) {
                for (std::size_t i = 0; i < places.size(); ++i) {
                    count(places[i], result.traced);
                    values[i] = image(places[i].x, places[i].y);
                }
            },
            [&](const PixelPlace& place, const PixelValue& value) {
                result.pixels[count(place, result.stored)] = value;
            });
    }
    return result;
}

float value(const PixelValue& v) {
    return v.radiance.g;
}
PixelValue grey(double v) {
    return {Rgb::grey(static_cast<float>(v)), 1};
}

}  // namespace

TEST_CASE(
    "every pixel is stored exactly once and traced at most once, by its own tile, for any size and "
    "spacing") {
    for (const int spacing : {1, 2, 3, 4, 7, 16}) {
        for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 40}, std::pair{33, 65},
                                            std::pair{50, 37}, std::pair{64, 64}}) {
            CAPTURE(spacing);
            CAPTURE(width);
            const Refined plain =
                refine([](int, int) { return grey(1); }, width, height, {spacing, 0.05, false});
            const Refined noisy =
                refine([](int x, int y) { return grey((x * 7 + y * 13) % 5 + 1); }, width, height,
                       {spacing, 0, false});
            for (const Refined* r : {&plain, &noisy}) {
                CHECK(
                    std::all_of(r->stored.begin(), r->stored.end(), [](int n) { return n == 1; }));
                CHECK(
                    std::all_of(r->traced.begin(), r->traced.end(), [](int n) { return n <= 1; }));
                CHECK(r->strays == 0);
            }
        }
    }
}

TEST_CASE("threshold 0 traces every pixel of a picture without equal neighbours") {
    const Image image = [](int x, int y) { return grey(1 + x + 100 * y); };
    const Refined r = refine(image, 50, 37, {4, 0, false});
    for (int y = 0; y < 37; ++y) {
        for (int x = 0; x < 50; ++x) CHECK(r.at(x, y, 50) == image(x, y));
    }
}

TEST_CASE(
    "where corners agree the picture is bilinear between them, so a linear picture is exact") {
    const Image image = [](int x, int y) { return grey(100 + 0.01 * x + 0.02 * y); };
    const Refined r = refine(image, 61, 45, {4, 0.05, false});
    for (int y = 0; y < 45; ++y) {
        for (int x = 0; x < 61; ++x)
            CHECK(value(r.at(x, y, 61)) == doctest::Approx(value(image(x, y))).epsilon(1e-6));
    }
    CHECK(r.rays() < 61 * 45 / 6);
}

TEST_CASE("a step is found to the pixel, and only squares on it are subdivided") {
    const Image image = [](int x, int) { return grey(x < 21 ? 1 : 2); };
    const Refined r = refine(image, 64, 64, {4, 0.05, false});
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) CHECK(r.at(x, y, 64) == image(x, y));
    }
    CHECK(r.rays() < 64 * 64 / 4);
}

TEST_CASE("a tile depends on what is traced in it alone, not on the picture that it is part of") {
    const Image image = [](int x, int y) {
        return grey(std::floor(2 + std::sin(0.3 * x) * std::cos(0.21 * y) * 2));
    };
    const RefineOptions options{4, 0.05, false};
    const int side = refine_tile_side(options.spacing);
    const Refined small = refine(image, side, side, options);
    const Refined large = refine(image, 3 * side, side + 17, options);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) CHECK(small.at(x, y, side) == large.at(x, y, 3 * side));
    }
}

namespace {

/// Uniform in [0, 1), a function of the arguments.
double noise(int x, int y, int seed) {
    return RandomStream::of_pixel(static_cast<std::uint64_t>(seed), static_cast<std::uint32_t>(x),
                                  static_cast<std::uint32_t>(y), 0)
        .next();
}

/// A wall in falling light with a window: trees in their own shade before it, and the sun through
/// their leaves, a sparkle in each fifth pixel, forty times as bright, elsewhere for each seed.
/// A dark bar one pixel wide divides the bright sky over the trees.
PixelValue window_with_sparkles(int x, int y, int seed) {
    const bool in_window = x >= 40 && x < 190 && y >= 30 && y < 150;
    if (!in_window) return grey(0.4 + 0.001 * x + 0.002 * y);
    if (y >= 130) return grey(x == 107 ? 0.1 : 5);
    if (noise(x, y, seed) < 1.0 / 5) return grey(10 + 5 * noise(x, y, seed + 1000));
    return grey(0.2 + 0.1 * noise(x, y, seed + 2000));
}

}  // namespace

TEST_CASE(
    "sparkles between samples are not lost: means are those of all pixels, for no more rays "
    "than rpict's pattern takes") {
    constexpr int kWidth = 240;
    constexpr int kHeight = 180;
    constexpr int kSeeds = 10;
    for (const RefineOptions options :
         {RefineOptions{2, 0.08, false}, RefineOptions{4, 0.05, false}}) {
        CAPTURE(options.spacing);
        double all = 0;
        double refined = 0;
        double rpict_mean = 0;
        long rays = 0;
        long rpict_rays = 0;
        for (int seed = 0; seed < kSeeds; ++seed) {
            const Image image = [&](int x, int y) { return window_with_sparkles(x, y, seed); };
            const Refined r = refine(image, kWidth, kHeight, options);
            rays += r.rays();
            const RpictPattern rpict(image, kWidth, kHeight, options);
            rpict_rays += rpict.rays();
            for (const PixelValue& pixel : rpict.pixels())
                rpict_mean += static_cast<double>(value(pixel));
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    all += static_cast<double>(value(image(x, y)));
                    refined += static_cast<double>(value(r.at(x, y, kWidth)));
                }
            }
        }
        MESSAGE("spacing " << options.spacing << ": mean " << 100 * (refined / all - 1)
                           << " % off with " << rays << " rays, by rpict's pattern "
                           << 100 * (rpict_mean / all - 1) << " % with " << rpict_rays);
        CHECK(std::abs(refined / all - 1) < 0.01);
        CHECK(rays <= rpict_rays);
    }
}

TEST_CASE("a thin wire that one sample hits is followed all along, be it dark or bright") {
    constexpr int kSide = 64;
    for (const double wire : {0.1, 50.0}) {
        const Image image = [&](int x, int y) { return grey(x == 9 + y / 5 ? wire : 5); };
        for (const int spacing : {3, 4, 6}) {
            CAPTURE(wire);
            CAPTURE(spacing);
            const Refined r = refine(image, kSide, kSide, {spacing, 0.05, false});
            for (int y = 0; y < kSide; ++y)
                CHECK(value(r.at(9 + y / 5, y, kSide)) == value(grey(wire)));
        }
    }
}

TEST_CASE("a large threshold leaves it at the first grid, sparkles or not") {
    const Image image = [](int x, int y) { return window_with_sparkles(x, y, 1); };
    const Refined r = refine(image, 240, 180, {8, 1e6, false});
    CHECK(r.rays() < 240 * 180 / 40);
}

TEST_CASE("differ compares each channel with the smaller value, and distances only on request") {
    const std::array<PixelValue, 2> near{PixelValue{{1, 1, 1}, 1}, PixelValue{{1, 1.04f, 1}, 2}};
    CHECK_FALSE(differ(near, {4, 0.05, false}));
    CHECK(differ(near, {4, 0.03, false}));
    CHECK(differ(near, {4, 0.05, true}));
    const std::array<PixelValue, 2> dark{PixelValue{{0, 0, 0}, 1}, PixelValue{{0, 0, 1e-9f}, 1}};
    CHECK(differ(dark, {4, 0.99, false}));
    CHECK_FALSE(differ(std::array<PixelValue, 2>{dark[0], dark[0]}, {4, 0, true}));
}
