#include "core/cloud/progressive.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

using Kind = PixelOrigin::Kind;

/// A row of pixels.
ProgressivePicture row(const std::vector<float>& light, const std::vector<PixelOrigin>& origins) {
    std::vector<Rgb> radiance;
    for (const float l : light) radiance.push_back(Rgb::grey(l));
    ProgressivePicture picture(static_cast<int>(light.size()), 1);
    picture.begin(radiance, origins);
    return picture;
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
    picture.record(work, std::vector<Rgb>(2, Rgb::grey(1)));  // there was time for two only
    work = picture.next(3);
    CHECK(places(work) == std::vector<int>{3, 0});
    picture.record(work, std::vector<Rgb>(2, Rgb::grey(1)));
    CHECK(picture.next(3).places.empty());  // nothing is steep
}

TEST_CASE("progressive view: at steps pixels get further rays, and show their mean") {
    ProgressivePicture picture =
        row({1, 1, 3, 3.1f}, std::vector<PixelOrigin>(4, {Kind::traced, 1, 0}));
    ProgressiveWork work = picture.next(9);
    CHECK(work.sample == 1);
    CHECK(places(work) == std::vector<int>{1, 2});
    picture.record(work, std::vector{Rgb::grey(3), Rgb::grey(1)});
    CHECK(picture.radiance()[1].g == doctest::Approx(2));
    CHECK(picture.radiance()[2].g == doctest::Approx(2));
    CHECK(places(picture.next(9)) == std::vector<int>{0, 3});  // steps, too, and with fewer rays
    int rounds = 0;
    for (work = picture.next(9); !work.places.empty() && rounds < 99;
         work = picture.next(9), ++rounds)
        picture.record(work, std::vector<Rgb>(work.places.size(), Rgb::grey(2)));
    CHECK(rounds < 99);  // it comes to an end
    for (const PixelOrigin& origin : picture.origins())
        CHECK(origin.samples <= ProgressivePicture::kMostSamples);
}
