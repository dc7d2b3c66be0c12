#include "parallel/refine.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "parallel/blocks.h"

using namespace lightwalk;

namespace {

using Image = std::function<PixelValue(int x, int y)>;

struct Refined {
    std::vector<PixelValue> pixels;
    std::vector<int> stored;  ///< how often each pixel was
    std::size_t traced = 0;
    std::size_t strays = 0;  ///< pixels stored outside their tile
    [[nodiscard]] const PixelValue& at(int x, int y, int width) const {
        return pixels[static_cast<std::size_t>(y * width + x)];
    }
};

/// Refine a whole picture, tile by tile, in the order of `make_blocks` or in rows.
Refined refine(const Image& image, int width, int height, const RefineOptions& options) {
    Refined result;
    result.pixels.resize(static_cast<std::size_t>(width * height));
    result.stored.resize(result.pixels.size());
    for (const Block& tile : make_blocks(width, height, refine_tile_side(options.spacing))) {
        refine_tile(
            tile, width, height, options,
            [&](std::span<const PixelPlace> places, std::span<PixelValue> values) {
                for (std::size_t i = 0; i < places.size(); ++i)
                    values[i] = image(places[i].x, places[i].y);
                result.traced += places.size();
            },
            [&](const PixelPlace& place, const PixelValue& value) {
                const bool inside = place.x >= tile.x0 && place.x < tile.x1 && place.y >= tile.y0 &&
                                    place.y < tile.y1;
                if (!inside) ++result.strays;
                const auto i = static_cast<std::size_t>(place.y * width + place.x);
                result.pixels[i] = value;
                ++result.stored[i];
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

TEST_CASE("every pixel is stored exactly once, by its own tile, for any size and spacing") {
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
    CHECK(r.traced < 61 * 45 / 6);
}

TEST_CASE("a step is found to the pixel, and only squares on it are subdivided") {
    const Image image = [](int x, int) { return grey(x < 21 ? 1 : 2); };
    const Refined r = refine(image, 64, 64, {4, 0.05, false});
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) CHECK(r.at(x, y, 64) == image(x, y));
    }
    CHECK(r.traced < 64 * 64 / 4);
}

TEST_CASE(
    "the result depends on the traced values alone: the same pixels of a larger picture are the "
    "same") {
    const Image image = [](int x, int y) {
        return grey(std::floor(2 + std::sin(0.3 * x) * std::cos(0.21 * y) * 2));
    };
    const RefineOptions options{4, 0.05, false};
    const Refined small = refine(image, 65, 65, options);
    const Refined large = refine(image, 129, 97, options);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) CHECK(small.at(x, y, 65) == large.at(x, y, 129));
    }
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
