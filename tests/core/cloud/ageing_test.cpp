#include "core/cloud/ageing.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/cloud/point_order.h"
#include "core/math/random.h"

using namespace lightwalk;

namespace {

constexpr ImagePlace kShown{1, 1, 1}, kOutside{}, kOfAnother{-1, -1, -1};
constexpr PointFate kStays = PointFate::stays, kGone = PointFate::gone;

}  // namespace

TEST_CASE("cloud: points live on while they are used, and so many frames without use") {
    std::vector<CloudPoint> points(4);
    points[0].age = 20;
    points[1].age = 24;
    points[2].age = 25;
    points[3].age = 255;
    const std::vector<std::uint8_t> used{1, 0, 0, 1};
    const std::vector<ImagePlace> places{kShown, kShown, kShown, kShown};
    std::vector<PointFate> fates(4);
    const AgeCounts counts = age_points(points, used, places, {25, true}, fates);
    CHECK((fates == std::vector{kStays, kStays, kGone, kStays}));
    CHECK(points[0].age == 0);
    CHECK(points[1].age == 25);
    CHECK(points[1].old == 1);
    CHECK((points[2].kind == PointKind::gone));
    CHECK((points[3].kind != PointKind::gone));
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
    std::vector<PointFate> fates(3);
    (void)age_points(points, used, places, {25, true}, fates);
    CHECK((fates == std::vector{kStays, kStays, kGone}));
    const AgeCounts counts = age_points(points, used, places, {25, false}, fates);
    CHECK((fates == std::vector{kStays, kGone, kGone}));
    CHECK(counts[0] == 1);  // what was gone does not come back
    CHECK(counts[1] == 0);
}

TEST_CASE(
    "cloud: what is out of the picture falls asleep where that is wished, but not others' points") {
    std::vector<CloudPoint> points(4);
    points[1].age = 8;
    points[3].age = 25;
    const std::vector<std::uint8_t> used(4);
    const std::vector<ImagePlace> places{kOutside, kOutside, kOfAnother, kShown};
    std::vector<PointFate> fates(4);
    const AgeCounts counts = age_points(points, used, places, {25, true, 8}, fates);
    CHECK((fates == std::vector{kStays, PointFate::sleeps, kGone, kGone}));
    CHECK((points[1].kind == PointKind::plain));
    CHECK(counts[1] == 1);
    CHECK(counts[9] == 0);
}

TEST_CASE("cloud: for want of room the longest unused points go") {
    AgeCounts counts{};
    counts[0] = 10000;
    counts[3] = 5000;
    counts[9] = 5000;
    CHECK(age_limit(counts, 20000) == AgeLimit{});
    CHECK(age_limit(counts, 12000).age == 3);
    CHECK(age_limit(counts, 15000).age == 9);
    CHECK(age_limit(counts, 0).age == 0);
    // All of an age that must go whole do.
    constexpr std::uint32_t kAll = ~std::uint32_t{0};
    CHECK(age_limit(counts, 15000).share == kAll);
    CHECK(age_limit(counts, 0).share == kAll);
    // Of others no fewer than must, and hardly more; others each frame.
    RandomStream random(3);
    std::vector<CloudPoint> points(5000);
    for (CloudPoint& point : points) point.position[0] = static_cast<float>(random.next());
    const AgeLimit limit = age_limit(counts, 12000);
    std::vector<std::size_t> gone;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (lot(points[i], frame) >= limit.share) continue;
            ++count;
            if (frame < 2) gone.push_back(i);
        }
        CHECK(count >= 3000);
        CHECK(count < 4000);
    }
    std::sort(gone.begin(), gone.end());
    const auto last = std::unique(gone.begin(), gone.end());
    CHECK(last - gone.begin() > 4000);
}
