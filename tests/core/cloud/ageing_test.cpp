#include "core/cloud/ageing.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

constexpr ImagePlace kShown{1, 1, 1}, kOutside{};

}  // namespace

TEST_CASE("cloud: points live on while they are used, and so many frames without use") {
    std::vector<CloudPoint> points(4);
    points[0].age = 20;
    points[1].age = 24;
    points[2].age = 25;
    points[3].age = 255;
    const std::vector<std::uint8_t> used{1, 0, 0, 1};
    const std::vector<ImagePlace> places{kShown, kShown, kShown, kShown};
    std::vector<std::uint8_t> keep(4);
    const AgeCounts counts = age_points(points, used, places, {25, true}, keep);
    CHECK(keep == std::vector<std::uint8_t>{1, 1, 0, 1});
    CHECK(points[0].age == 0);
    CHECK(points[1].age == 25);
    CHECK(points[1].old == 1);
    CHECK(points[2].kind == PointKind::gone);
    CHECK(points[3].kind != PointKind::gone);
    CHECK(points[3].age == 0);
    CHECK(counts[0] == 2);
    CHECK(counts[25] == 1);
}

TEST_CASE(
    "cloud: what the picture no longer shows goes, and without supersaturation all unused points "
    "do") {
    std::vector<CloudPoint> points(3);
    const std::vector<std::uint8_t> used{1, 0, 0};
    const std::vector<ImagePlace> places{kShown, kShown, kOutside};
    std::vector<std::uint8_t> keep(3);
    (void)age_points(points, used, places, {25, true}, keep);
    CHECK(keep == std::vector<std::uint8_t>{1, 1, 0});
    const AgeCounts counts = age_points(points, used, places, {25, false}, keep);
    CHECK(keep == std::vector<std::uint8_t>{1, 0, 0});
    CHECK(counts[0] == 1);  // what was gone does not come back
    CHECK(counts[1] == 0);
}

TEST_CASE("cloud: for want of room the longest unused points go") {
    AgeCounts counts{};
    counts[0] = 10;
    counts[3] = 5;
    counts[9] = 5;
    CHECK(age_limit(counts, 20).age == kOldestAge);
    CHECK(age_limit(counts, 20).at_limit == 0);
    CHECK(age_limit(counts, 12).age == 3);
    CHECK(age_limit(counts, 12).at_limit == 3);
    CHECK(age_limit(counts, 15).age == 9);
    CHECK(age_limit(counts, 15).at_limit == 5);
    CHECK(age_limit(counts, 0).age == 0);
    CHECK(age_limit(counts, 0).at_limit == 10);
}
