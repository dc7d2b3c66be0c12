#include "core/cloud/surface_fill.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace lightwalk;

namespace {

constexpr int kFillWidth = 64, kFillHeight = 48;
constexpr std::uint32_t kWall = 1, kTable = 2;

/// Left of x = 32 a wall, 4 m away, right of it a table, 2 m away.
std::uint32_t surface_at(const PixelPlace& place) {
    return place.x < 32 ? kWall : kTable;
}
float distance_at(const PixelPlace& place) {
    return place.x < 32 ? 4.0f : 2.0f;
}
/// Of the wall the light rises with x, the table is bright.
Rgb color_at(const PixelPlace& place) {
    return place.x < 32 ? Rgb::grey(static_cast<float>(place.x)) : Rgb::grey(100);
}

/// Looks at the two surfaces; nothing is to be traced here.
class TwoSurfaces final : public PixelCaster {
  public:
    void probe(std::span<const PixelPlace> places, const ProbeOptions&,
               std::span<PixelVisibility> visibility, int) override {
        for (std::size_t i = 0; i < places.size(); ++i) {
            visibility[i] = {};
            visibility[i].ray = true;
            visibility[i].ahead.seen = true;
            visibility[i].ahead.surface = surface_at(places[i]);
            visibility[i].ahead.distance = distance_at(places[i]);
        }
        probed += places.size();
    }
    void trace(std::span<const PixelPlace>, std::span<TracedPixel>, int, int) override {
        FAIL("nothing is traced");
    }
    std::size_t probed = 0;
};

CloudFrame frame_of_grid(int step) {
    CloudFrame frame;
    frame.area = {0, 0, kFillWidth, kFillHeight};
    frame.radiance.resize(frame.area.pixels());
    frame.distance.resize(frame.area.pixels());
    frame.known.resize(frame.area.pixels());
    frame.surfaces.resize(frame.area.pixels());
    frame.patterns.resize(frame.area.pixels(), kNoPattern);
    for (int y = 0; y < kFillHeight; y += step) {
        for (int x = 0; x < kFillWidth; x += step) {
            const PixelPlace place{x, y};
            const std::size_t at = frame.area.index(place);
            frame.radiance[at] = color_at(place);
            frame.distance[at] = distance_at(place);
            frame.surfaces[at] = surface_at(place);
            frame.known[at] = 1;
        }
    }
    return frame;
}

std::vector<InferredPixel> fill(CloudFrame& frame, TwoSurfaces& caster) {
    std::vector<InferredPixel> found;
    infer_block(frame, frame.area, caster, 0, found);
    show_inferred(found, frame);
    return found;
}

}  // namespace

TEST_CASE("surface fill: edges are where they are, light is that of the same surface") {
    for (const int step : {2, 4, 8}) {
        CAPTURE(step);
        CloudFrame frame = frame_of_grid(step);
        TwoSurfaces caster;
        const auto known = static_cast<std::size_t>(
            std::count(frame.known.begin(), frame.known.end(), std::uint8_t{1}));
        (void)fill(frame, caster);
        CHECK(caster.probed == frame.area.pixels() - known);
        CHECK(frame.report.inferred == caster.probed);
        for (int y = 0; y < kFillHeight; ++y) {
            for (int x = 0; x < kFillWidth; ++x) {
                const std::size_t at = frame.area.index({x, y});
                REQUIRE(frame.known[at] == 1);
                REQUIRE(frame.distance[at] == distance_at({x, y}));
                const float error = std::abs(frame.radiance[at].g - color_at({x, y}).g);
                REQUIRE(error <= (x < 32 ? 1.5f * static_cast<float>(step) : 0.001f));
            }
        }
    }
}

TEST_CASE(
    "surface fill: what is as far away stands for a surface that was not seen, else nothing") {
    CloudFrame frame = frame_of_grid(4);
    for (std::size_t i = 0; i < frame.known.size(); ++i)
        if (frame.surfaces[i] == kTable) frame.surfaces[i] = 7;  // another one, at the same depth
    TwoSurfaces caster;
    (void)fill(frame, caster);
    const std::size_t table = frame.area.index({41, 9});
    CHECK(frame.radiance[table].g == doctest::Approx(100));
    CHECK(frame.report.inferred == (kFillWidth / 2) * kFillHeight * 15 / 16);

    CloudFrame apart = frame_of_grid(4);
    for (std::size_t i = 0; i < apart.known.size(); ++i)
        if (apart.surfaces[i] == kTable) apart.known[i] = 0;
    (void)fill(apart, caster);
    CHECK(apart.known[table] == 0);
    CHECK(apart.radiance[table] == Rgb{});
}

TEST_CASE("surface fill: what is of the same material comes before all else that is as far away") {
    CloudFrame frame = frame_of_grid(4);
    for (std::size_t i = 0; i < frame.known.size(); ++i) {
        if (frame.surfaces[i] != kTable) continue;
        const bool stone = i % 8 == 0;  // every other column that is known
        frame.surfaces[i] = stone ? kTable + 1 : kTable + kMaterialBits + 1;
        if (stone) frame.radiance[i] = Rgb::grey(7);
    }
    TwoSurfaces caster;
    (void)fill(frame, caster);
    CHECK(frame.radiance[frame.area.index({41, 9})].g == doctest::Approx(100));
    CHECK(frame.report.inferred == kFillWidth * kFillHeight * 15 / 16);
}

TEST_CASE("surface fill: patterns are those of the pixels themselves, light that of others") {
    // Boards of a wall in even light: neighbours lie on boards of other brightness.
    const auto pattern_of = [](int x) { return x % 3 == 0 ? 0.5f : x % 3 == 1 ? 1.0f : 2.0f; };
    constexpr float kLight = 8;
    CloudFrame frame = frame_of_grid(4);
    for (int y = 0; y < kFillHeight; ++y) {
        for (int x = 0; x < 32; ++x) {
            const std::size_t at = frame.area.index({x, y});
            frame.radiance[at] = Rgb{kLight, kLight / 2, 0} * pattern_of(x);
            frame.patterns[at] = encode_pattern(pattern_of(x));
        }
    }
    for (int x = 0; x < 32; ++x) {
        PixelVisibility visibility;
        visibility.ray = visibility.ahead.seen = true;
        visibility.ahead.surface = kWall;
        visibility.ahead.distance = 4;
        visibility.ahead.pattern = pattern_of(x);
        const std::optional<InferredPixel> pixel = infer_pixel(frame, {x, 9}, visibility);
        REQUIRE(pixel);
        CAPTURE(x);
        CHECK(pixel->radiance.r == doctest::Approx(kLight * pattern_of(x)).epsilon(0.05));
        CHECK(pixel->radiance.g == doctest::Approx(kLight / 2 * pattern_of(x)).epsilon(0.05));
        CHECK(pixel->radiance.b == 0);
    }
}

TEST_CASE("surface fill: where all that is known is black, nothing becomes bright") {
    CloudFrame frame = frame_of_grid(4);
    for (std::size_t i = 0; i < frame.patterns.size(); ++i) {
        frame.radiance[i] = Rgb::grey(0.02f);  // a highlight on a black board
        frame.patterns[i] = encode_pattern(0.0005f);
    }
    PixelVisibility visibility;
    visibility.ray = visibility.ahead.seen = true;
    visibility.ahead.surface = kWall;
    visibility.ahead.distance = 4;
    for (const float pattern : {0.0f, 0.0005f, 1.0f, 100.0f}) {
        visibility.ahead.pattern = pattern;
        const std::optional<InferredPixel> pixel = infer_pixel(frame, {9, 9}, visibility);
        REQUIRE(pixel);
        CHECK(pixel->radiance.g >= 0);
        CHECK(pixel->radiance.g <= 0.08f);
    }
    std::fill(frame.patterns.begin(), frame.patterns.end(), encode_pattern(0));
    visibility.ahead.pattern = 0;
    CHECK(std::isfinite(infer_pixel(frame, {9, 9}, visibility)->radiance.g));
}

TEST_CASE("surface fill: pixels without a ray, and those that are known, stay as they are") {
    CloudFrame frame = frame_of_grid(1);
    TwoSurfaces caster;
    CHECK(fill(frame, caster).empty());
    CHECK(caster.probed == 0);
    frame.known[5] = 0;
    CHECK_FALSE(infer_pixel(frame, {5, 0}, PixelVisibility{}));
}
