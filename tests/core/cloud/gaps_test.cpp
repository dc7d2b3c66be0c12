#include "core/cloud/gaps.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace lightwalk;

namespace {

constexpr int kWidth = 37, kHeight = 21;  // halves are not whole

struct GappyPicture {
    std::vector<Rgb> radiance = std::vector<Rgb>(kWidth * kHeight, Rgb::grey(-7));
    std::vector<std::uint8_t> known = std::vector<std::uint8_t>(kWidth * kHeight, 0);

    void set(int x, int y, float light) {
        radiance[static_cast<std::size_t>(y * kWidth + x)] = Rgb::grey(light);
        known[static_cast<std::size_t>(y * kWidth + x)] = 1;
    }
    void fill() { fill_gaps(kWidth, kHeight, radiance, known); }
    [[nodiscard]] float at(int x, int y) const {
        return radiance[static_cast<std::size_t>(y * kWidth + x)].g;
    }
};

}  // namespace

TEST_CASE("gaps: known pixels stay, and an even picture is even all over") {
    GappyPicture picture;
    for (int y = 0; y < kHeight; y += 5)
        for (int x = 0; x < kWidth; x += 7) picture.set(x, y, 3);
    picture.fill();
    for (const Rgb& color : picture.radiance) CHECK(color.g == doctest::Approx(3));
}

TEST_CASE("gaps: what is filled lies between what is known, and is nearer to the nearer of it") {
    GappyPicture picture;
    for (int y = 0; y < kHeight; ++y) {
        picture.set(0, y, 1);
        picture.set(kWidth - 1, y, 5);
    }
    picture.fill();
    CHECK(picture.at(0, 4) == 1);
    CHECK(picture.at(kWidth - 1, 4) == 5);
    for (const Rgb& color : picture.radiance) CHECK((color.g >= 1 && color.g <= 5.0001f));
    CHECK(picture.at(3, 10) < 2);
    CHECK(picture.at(kWidth - 4, 10) > 4);
}

TEST_CASE("gaps: one known pixel fills a picture, none leaves it alone") {
    GappyPicture none;
    none.fill();
    CHECK(none.at(5, 5) == -7);
    GappyPicture one;
    one.set(30, 2, 2);
    one.fill();
    CHECK(std::all_of(one.radiance.begin(), one.radiance.end(),
                      [](const Rgb& c) { return c == Rgb::grey(2); }));
}
