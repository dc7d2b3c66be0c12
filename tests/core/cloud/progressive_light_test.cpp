#include "core/cloud/progressive_light.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace lightwalk;

namespace {

constexpr int kAcross = 33, kDown = 17;
constexpr float kNear = 2, kFar = 8;

std::size_t index_of(const PixelPlace& place) {
    return static_cast<std::size_t>(place.y * kAcross + place.x);
}

/// The left half is near, the right half far; each has as much more light as is given.
struct Rested {
    Rested(float left, float right, bool drafted = false) : won{left, right} {
        std::vector<float> distance;
        for (int i = 0; i < kAcross * kDown; ++i)
            distance.push_back(i % kAcross < kAcross / 2 ? kNear : kFar);
        light.begin(std::vector<Rgb>(distance.size(), Rgb::grey(1)), distance, {}, drafted);
    }
    [[nodiscard]] PixelValue value(const PixelPlace& place) const {
        const bool near = place.x < kAcross / 2;
        return {Rgb::grey(1 + won[near ? 0 : 1]), near ? kNear : kFar};
    }
    /// Trace at most so many pixels.
    bool step(std::size_t most) {
        return light.step([&](const ProgressiveWork& work) {
            std::vector<std::optional<PixelValue>> values(work.places.size());
            for (std::size_t i = 0; i < std::min(most, values.size()); ++i) {
                values[i] = value(work.places[i]);
                ++traced;
            }
            return values;
        });
    }
    /// What is traced before any pixel counts.
    void play_overture() {
        const std::size_t places = 5 * 3;  // every 8th pixel of every 8th row
        while (traced < places) CHECK(step(places - traced));
        traced = 0;
    }
    float won[2];
    ProgressiveLight light{kAcross, kDown, 1};
    std::size_t traced = 0;
};

/// Largest difference of neighbours that are equally far away.
float roughness(const std::vector<Rgb>& picture) {
    float most = 0;
    for (int y = 0; y < kDown; ++y)
        for (int x = 1; x < kAcross; ++x) {
            if (x == kAcross / 2) continue;
            const Rgb a = picture[index_of({x, y})], b = picture[index_of({x - 1, y})];
            most = std::max(most, std::abs(a.g - b.g));
        }
    return most;
}

}  // namespace

TEST_CASE("progressive light: no pixel stands out from the wall that it is on, at any time") {
    Rested rested(4, 4);
    CHECK(rested.light.picture() == std::vector<Rgb>(kAcross * kDown, Rgb::grey(1)));
    while (rested.step(5)) CHECK(roughness(rested.light.picture()) < 1e-5f);
    CHECK(rested.light.share() == 1);
    for (const Rgb& pixel : rested.light.picture()) CHECK(pixel.g == 5);
}

TEST_CASE("progressive light: until the coarsest grid is whole the picture is that of before") {
    Rested rested(4, 4);
    rested.play_overture();
    CHECK(rested.light.share() == 0);
    CHECK(rested.light.picture() == std::vector<Rgb>(kAcross * kDown, Rgb::grey(1)));
    const std::size_t coarsest = 3 * 2;  // every 16th pixel of every 16th row
    CHECK(rested.step(coarsest - 1));
    CHECK(rested.light.picture() == std::vector<Rgb>(kAcross * kDown, Rgb::grey(1)));
    CHECK(rested.step(1));
    for (const Rgb& pixel : rested.light.picture()) CHECK(pixel.g == doctest::Approx(5));
}

TEST_CASE(
    "progressive light: of a draft no grid is shown that is coarser than every fourth pixel") {
    Rested rested(4, 4, true);
    rested.play_overture();
    const std::size_t every_fourth = 9 * 5;
    while (rested.traced < every_fourth) {
        CHECK(rested.light.picture() == std::vector<Rgb>(kAcross * kDown, Rgb::grey(1)));
        CHECK(rested.step(5));
    }
    for (const Rgb& pixel : rested.light.picture()) CHECK(pixel.g == doctest::Approx(5));
}

TEST_CASE("progressive light: what is far behind an edge gets hardly any light from before it") {
    Rested rested(4, 0);
    rested.play_overture();
    while (rested.traced < 6) CHECK(rested.step(6 - rested.traced));
    const std::vector<Rgb> picture = rested.light.picture();
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const PixelPlace place{x, y};
            CHECK(picture[index_of(place)].g ==
                  doctest::Approx(rested.value(place).radiance.g).epsilon(0.3));
        }
}

TEST_CASE("progressive light: every picture ends as the tracer draws it") {
    Rested rested(3, -0.5f);
    while (rested.step(100)) {
    }
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x)
            CHECK(rested.light.picture()[index_of({x, y})] == rested.value({x, y}).radiance);
}
