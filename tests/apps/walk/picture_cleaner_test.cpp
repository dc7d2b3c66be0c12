#include "apps/walk/picture_cleaner.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

Picture two_pixels(float value) {
    return {2, 1, {Rgb::grey(value), Rgb::grey(2 * value)}};
}

/// Waits for it; nothing: it has not come true for a minute.
template <class Condition>
bool comes_true(const Condition& condition) {
    for (int i = 0; i < 60000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

bool halve(Picture& picture, const std::function<bool()>& /*goes_on*/) {
    for (Rgb& pixel : picture.pixels) pixel *= 0.5F;
    return true;
}

}  // namespace

TEST_CASE("picture cleaner: a picture comes back clean, once") {
    PictureCleaner cleaner(halve);
    CHECK_FALSE(cleaner.is_busy());
    CHECK_FALSE(cleaner.take());
    for (const float value : {1.F, 3.F}) {
        cleaner.begin(two_pixels(value));
        CHECK(cleaner.is_busy());
        std::optional<std::vector<Rgb>> made;
        REQUIRE(comes_true([&] { return (made = cleaner.take()).has_value(); }));
        CHECK(*made == two_pixels(value / 2).pixels);
        CHECK_FALSE(cleaner.is_busy());
        CHECK_FALSE(cleaner.take());
    }
    CHECK(cleaner.problem().empty());
}

TEST_CASE("picture cleaner: what is given up, or replaced, ends soon and never comes") {
    std::atomic<int> begun{0}, ended{0};
    PictureCleaner cleaner([&](Picture& picture, const std::function<bool()>& goes_on) {
        ++begun;
        if (picture.pixels[0].g == 7) return true;
        while (goes_on()) std::this_thread::yield();  // for ever, while it is wanted
        ++ended;
        return true;  // all the same
    });
    cleaner.begin(two_pixels(1));
    REQUIRE(comes_true([&] { return begun == 1; }));
    cleaner.give_up();
    CHECK_FALSE(cleaner.is_busy());
    REQUIRE(comes_true([&] { return ended == 1; }));
    cleaner.begin(two_pixels(2));
    REQUIRE(comes_true([&] { return begun == 2; }));
    CHECK_FALSE(cleaner.take());
    cleaner.begin(two_pixels(7));
    std::optional<std::vector<Rgb>> made;
    REQUIRE(comes_true([&] { return (made = cleaner.take()).has_value(); }));
    CHECK(*made == two_pixels(7).pixels);
    CHECK(ended == 2);
    cleaner.begin(two_pixels(3));  // and is destroyed
    REQUIRE(comes_true([&] { return begun == 4; }));
}

TEST_CASE("picture cleaner: one that fails says why, and is asked no more") {
    std::atomic<int> begun{0};
    PictureCleaner cleaner([&](Picture&, const std::function<bool()>&) -> bool {
        ++begun;
        throw InputError("no memory");
    });
    cleaner.begin(two_pixels(1));
    REQUIRE(comes_true([&] { return !cleaner.problem().empty(); }));
    CHECK(cleaner.problem() == "no memory");
    CHECK_FALSE(cleaner.is_busy());
    cleaner.begin(two_pixels(2));
    CHECK_FALSE(cleaner.is_busy());
    CHECK_FALSE(cleaner.take());
    CHECK(begun == 1);
}
