#include "core/cloud/region_points.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

constexpr int kRegionSide = 8;

/// The left half of a picture.
struct LeftHalf {
    LeftHalf() { points.begin(camera); }
    /// A point that the picture shows in the middle of a pixel.
    [[nodiscard]] CloudPoint at(int x, int y) const {
        const auto ray = camera.ray((x + 0.5) / kRegionSide, (y + 0.5) / kRegionSide);
        const Vec3 position = ray->origin + 5 * ray->direction;
        CloudPoint point;
        for (std::size_t k = 0; k < 3; ++k) point.position[k] = static_cast<float>(position[k]);
        return point;
    }
    void add(const std::vector<PixelPlace>& places) {
        for (const PixelPlace& place : places) points.add(std::vector{at(place.x, place.y)});
    }
    /// How many points are kept when those that were not used are dropped.
    [[nodiscard]] std::size_t kept() {
        (void)points.age({25, false}, SerialTaskRunner());
        points.keep({}, 0, SerialTaskRunner());
        return points.all().size();
    }

    Camera camera{View{}};
    RegionPoints points{{0, 0, kRegionSide / 2, kRegionSide}, kRegionSide, kRegionSide};
};

}  // namespace

TEST_CASE("region points: others are told of those at the region's inner edge, and beyond it") {
    LeftHalf half;
    half.add({{0, 0}, {2, 7}, {3, 4}, {4, 4}, {6, 1}});
    std::vector<PixelPlace> told;
    half.points.leaving([&](const CloudPoint&, const PixelPlace& place, std::span<const Rgb>) {
        told.push_back(place);
    });
    CHECK(told == std::vector<PixelPlace>{{3, 4}, {4, 4}, {6, 1}});
}

TEST_CASE("region points: what pixels use is kept, new points take the places of those that go") {
    LeftHalf half;
    half.add({{0, 0}, {1, 1}, {2, 2}, {3, 3}});
    half.points.use(1);
    half.points.use(3);
    PixelPoints fresh;
    fresh.points[0] = half.at(0, 5);
    fresh.count = 1;
    half.points.leave(fresh);
    CHECK(half.kept() == 3);
    // A second frame, in which pixels show two of them.
    half.points.begin(half.camera);
    half.points.project(SerialTaskRunner());
    ReuseRules rules;
    rules.drop_lonely = false;
    const PointFinder finder = half.points.finder(rules);
    CHECK(finder.unchecked({0, 0}).ahead == kNoPoint);
    for (const PixelPlace place : {PixelPlace{1, 1}, PixelPlace{0, 5}}) {
        const std::uint32_t found = finder.unchecked(place).ahead;
        REQUIRE(found != kNoPoint);
        half.points.use(found);
    }
    CHECK(half.kept() == 2);
}

TEST_CASE("region points: what others use is kept, and they are told what is used of theirs") {
    LeftHalf half;
    half.add({{1, 1}, {2, 2}, {4, 4}});
    half.points.use(2);
    const UsedPixels used = half.points.used_beside();
    CHECK(used.ahead == std::vector<PixelPlace>{{4, 4}});
    CHECK(used.mirrored.empty());
    half.points.mark_used({{{2, 2}, {6, 6}}, {}});  // of which one is not its own
    CHECK(half.kept() == 1);                        // the other one lies outside
}

TEST_CASE("region points: of a view that rests all stay") {
    LeftHalf half;
    half.add({{1, 1}, {2, 2}});
    const AgeCounts ages = half.points.rest();
    CHECK(ages[0] == 2);
    half.points.keep({}, 0, SerialTaskRunner());
    CHECK(half.points.all().size() == 2);
}
