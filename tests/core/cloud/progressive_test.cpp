#include "core/cloud/progressive.h"

#include <doctest/doctest.h>

#include <optional>
#include <vector>

using namespace lightwalk;

namespace {

using Kind = PixelOrigin::Kind;

/// A row of pixels.
ProgressivePicture row(const std::vector<float>& light, const std::vector<PixelOrigin>& origins) {
    std::vector<Rgb> radiance;
    for (const float l : light) radiance.push_back(Rgb::grey(l));
    ProgressivePicture picture(static_cast<int>(light.size()), 1);
    picture.begin(radiance, std::vector<float>(light.size()), origins);
    return picture;
}

/// So many pixels were traced.
std::vector<std::optional<PixelValue>> grey_values(const std::vector<float>& light) {
    std::vector<std::optional<PixelValue>> values;
    for (const float l : light) values.push_back(PixelValue{Rgb::grey(l), 5});
    return values;
}

std::vector<int> places(const ProgressiveWork& work) {
    std::vector<int> xs;
    for (const PixelPlace& place : work.places) xs.push_back(place.x);
    return xs;
}

}  // namespace

TEST_CASE(
    "progressive view: filled pixels come first, coarse grids before fine ones, then reused ones "
    "by "
    "age") {
    ProgressivePicture picture = row({1, 1, 1, 1, 1}, {{Kind::reused, 0, 9},
                                                       {Kind::traced, 1, 0},
                                                       {Kind::filled, 0, 0},
                                                       {Kind::reused, 0, 3},
                                                       {Kind::filled, 0, 0}});
    ProgressiveWork work = picture.next(3);
    CHECK(work.sample == 0);
    CHECK(places(work) == std::vector<int>{4, 2, 3});
    auto values = grey_values({1, 1, 1});
    values[1].reset();  // there was time for two only
    picture.record(work, values);
    CHECK(picture.distance()[4] == 5);
    CHECK(picture.distance()[2] == 0);
    CHECK(picture.distance()[3] == 5);
    work = picture.next(3);
    CHECK(places(work) == std::vector<int>{2, 0});
    picture.record(work, grey_values({1, 1}));
    CHECK(picture.next(3).places.empty());  // nothing is steep
}

TEST_CASE("progressive view: at steps pixels get further rays, and show their mean") {
    ProgressivePicture picture =
        row({1, 1, 3, 3.1f}, std::vector<PixelOrigin>(4, {Kind::traced, 1, 0}));
    ProgressiveWork work = picture.next(9);
    CHECK(work.sample == 1);
    CHECK(places(work) == std::vector<int>{1, 2});
    picture.record(work, grey_values({3, 1}));
    CHECK(picture.distance()[1] == 0);  // is that of the first ray
    CHECK(picture.radiance()[1].g == doctest::Approx(2));
    CHECK(picture.radiance()[2].g == doctest::Approx(2));
    CHECK(places(picture.next(9)) == std::vector<int>{0, 3});  // steps, too, and with fewer rays
    int rounds = 0;
    for (work = picture.next(9); !work.places.empty() && rounds < 99;
         work = picture.next(9), ++rounds)
        picture.record(work, grey_values(std::vector<float>(work.places.size(), 2)));
    CHECK(rounds < 99);  // it comes to an end
    for (const PixelOrigin& origin : picture.origins())
        CHECK(origin.samples <= ProgressivePicture::kMostSamples);
}

TEST_CASE("progressive view: edges that few rays have shown do not hold up the others") {
    // Bars of two pixels, all of them edges; the first one has fewer rays.
    constexpr int kBars = 64;
    std::vector<float> greys;
    std::vector<PixelOrigin> origins(2 * kBars, {Kind::traced, 2, 0});
    for (int i = 0; i < 2 * kBars; ++i) greys.push_back(i / 2 % 2 == 0 ? 1.0f : 3.0f);
    origins[0].samples = origins[1].samples = 1;
    ProgressivePicture picture = row(greys, origins);
    CHECK(picture.next(999).sample == 2);
    CHECK(picture.next(999).places.size() > kBars);
    int passes = 0;
    for (ProgressiveWork work = picture.next(999); !work.places.empty() && passes < 99;
         work = picture.next(999), ++passes) {
        std::vector<float> same;
        for (const PixelPlace& place : work.places)
            same.push_back(greys[static_cast<std::size_t>(place.x)]);
        picture.record(work, grey_values(same));
    }
    CHECK(passes < 2 * ProgressivePicture::kMostSamples);
    CHECK(picture.finished());
    CHECK(picture.origins()[1].samples == ProgressivePicture::kMostSamples);
}

TEST_CASE("progressive view: a finished picture is the same however much was traced at a time") {
    // Rays that have much to say, of which some are without time.
    constexpr int kSide = 40;
    const auto ray = [](const PixelPlace& place, int sample) {
        const auto x = static_cast<unsigned>(place.x / 3), y = static_cast<unsigned>(place.y / 5);
        const unsigned mixed = (x * 73U + y * 151U + static_cast<unsigned>(sample) * 37U) % 11U;
        return PixelValue{Rgb::grey(1 + 0.1f * static_cast<float>(mixed)), 5};
    };
    const auto finish = [&](std::size_t most, std::size_t without_time) {
        ProgressivePicture picture(kSide, kSide);
        const std::vector<Rgb> black(kSide * kSide);
        picture.begin(black, std::vector<float>(black.size()),
                      std::vector<PixelOrigin>(black.size()));
        std::size_t rays = 0;
        for (ProgressiveWork work = picture.next(most); !work.places.empty();
             work = picture.next(most)) {
            std::vector<std::optional<PixelValue>> traced;
            for (const PixelPlace& place : work.places)
                traced.push_back(++rays % without_time == 0
                                     ? std::nullopt
                                     : std::optional(ray(place, work.sample)));
            picture.record(work, traced);
        }
        CHECK(picture.finished());
        return std::vector<Rgb>(picture.radiance().begin(), picture.radiance().end());
    };
    const std::vector<Rgb> at_once = finish(kSide * kSide, 1000000);
    CHECK(finish(7, 1000000) == at_once);
    CHECK(finish(100, 3) == at_once);
    CHECK(finish(1, 2) == at_once);
}
