// Points out of the picture: they sleep, and wake where a view shows them.
#include "core/cloud/sleeping_points.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/cloud/point_order.h"
#include "core/cloud/region_points.h"
#include "core/math/random.h"

using namespace lightwalk;

namespace {

constexpr int kSleepWidth = 64, kSleepHeight = 48;

View looking(const Vec3& direction, const Vec3& position = {}) {
    View view;
    view.position = position;
    view.direction = direction;
    view.horizontal = 60;
    view.vertical = 46.8;
    return view;
}

/// Points around, some of them of the background.
std::vector<CloudPoint> points_around(std::size_t count) {
    RandomStream random(5);
    std::vector<CloudPoint> points(count);
    for (CloudPoint& point : points) {
        const float far = random.next() < 0.1 ? 1e10f : 5;
        for (float& x : point.position) x = far * static_cast<float>(2 * random.next() - 1);
    }
    return points;
}

void sort(std::vector<CloudPoint>& points) {
    std::ranges::sort(points, precedes);
}

}  // namespace

TEST_CASE("sleeping points: all that a view shows wake, others by the way only, and none is lost") {
    const std::vector<CloudPoint> all = points_around(40'000);
    std::vector<CloudPoint> tired = all, awake;
    std::vector<Rgb> none;
    SleepingPoints sleeping;
    sleeping.add(tired);
    CHECK(sleeping.size() == all.size());
    const Camera camera(looking({1, 0.4, 0.2}, {0.5, -1, 0}));
    const PointProjector projector(camera, kSleepWidth, kSleepHeight);
    sleeping.wake(projector, all.size(), awake, none);
    std::size_t shown = 0, shown_awake = 0;
    for (const CloudPoint& point : all) shown += projector(point.place()).distance > 0 ? 1 : 0;
    for (const CloudPoint& point : awake)
        shown_awake += projector(point.place()).distance > 0 ? 1 : 0;
    CHECK(shown > 1000);
    CHECK(shown_awake == shown);
    CHECK(awake.size() < all.size() / 2);
    CHECK(sleeping.size() == all.size() - awake.size());
    // Nobody takes them for just shown: age 0 would be.
    CHECK(std::ranges::all_of(awake, [](const CloudPoint& p) { return p.age == 1; }));
    // Those that are left wake in other views.
    for (const Vec3& direction : {Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}})
        for (const double up : {-2.0, 0.0, 2.0}) {
            const Camera other(looking(direction + Vec3{0, 0, up}));
            sleeping.wake(PointProjector(other, kSleepWidth, kSleepHeight), all.size(), awake,
                          none);
        }
    std::vector<CloudPoint> found = awake, wanted = all;
    for (CloudPoint& point : found) point.age = 0;
    sort(found);
    sort(wanted);
    CHECK(std::ranges::includes(wanted, found, precedes));
    CHECK(found.size() + sleeping.size() == all.size());
    CHECK(sleeping.size() < all.size() / 10);
}

TEST_CASE("sleeping points: for want of room those go that have slept longest") {
    SleepingPoints sleeping;
    std::vector<CloudPoint> first(1000), second(1000), awake;
    std::vector<Rgb> none;
    for (CloudPoint& point : first) point.position = {3, 0, 0};
    for (CloudPoint& point : second) point.position = {3, 0.1f, 0};
    sleeping.add(first);
    sleeping.add(second);
    const Camera camera(looking({1, 0, 0}));
    const PointProjector projector(camera, kSleepWidth, kSleepHeight);
    // Those that fell asleep last wake first.
    sleeping.wake(projector, 100, awake, none);
    CHECK(awake.size() >= 100);
    CHECK(awake.size() < 300);
    CHECK(std::ranges::all_of(awake, [](const CloudPoint& p) { return p.position[1] > 0; }));
    sleeping.add(awake);
    awake.clear();
    sleeping.limit(1000);
    CHECK(sleeping.size() <= 1000);
    CHECK(sleeping.size() > 800);  // whole groups go
    sleeping.wake(projector, 1000, awake, none);
    CHECK(std::ranges::all_of(awake, [](const CloudPoint& p) { return p.position[1] > 0; }));
    sleeping.limit(0);
    CHECK(sleeping.size() == 0);
}

TEST_CASE("region points: who looks away and back finds the points again, where they may sleep") {
    for (const int kAwakeFrames : {0, 3}) {
        CAPTURE(kAwakeFrames);
        const Camera there(looking({1, 0, 0})), away(looking({0, 1, 0}));
        RegionPoints points({0, 0, kSleepWidth, kSleepHeight}, kSleepWidth, kSleepHeight);
        const auto frame = [&](const Camera& camera) {
            points.begin(camera);
            points.project(SerialTaskRunner());
            const AgeCounts ages = points.age({25, true, kAwakeFrames}, SerialTaskRunner());
            points.keep({}, 0, SerialTaskRunner());
            return ages;
        };
        points.begin(there);
        points.project(SerialTaskRunner());
        for (CloudPoint& point : points_around(50'000))
            if (PointProjector(there, kSleepWidth, kSleepHeight)(point.place()).distance > 0)
                points.add({&point, 1});
        const std::size_t all = points.all().size();
        CHECK(all > 100);
        for (int i = 0; i < 30; ++i) (void)frame(away);
        // Groups at the border wake for nothing.
        CHECK(points.all().size() <= (kAwakeFrames > 0 ? all / 4 : 0));
        (void)frame(there);
        CHECK(points.all().size() == (kAwakeFrames > 0 ? all : 0));
    }
}

TEST_CASE("sleeping points: what light groups add to a point falls asleep and wakes with it") {
    constexpr std::size_t kGroups = 2;
    std::vector<CloudPoint> points = points_around(3000);
    std::vector<Rgb> groups;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        points[i].surface = i;
        for (std::size_t g = 0; g < kGroups; ++g)
            groups.emplace_back(static_cast<float>(i), static_cast<float>(g), 0.0f);
    }
    SleepingPoints sleeping;
    sleeping.add(points, groups);
    std::vector<CloudPoint> awake;
    std::vector<Rgb> of_awake;
    const Camera camera(looking({1, 0, 0}));
    sleeping.wake(PointProjector(camera, kSleepWidth, kSleepHeight), points.size(), awake,
                  of_awake);
    REQUIRE(!awake.empty());
    REQUIRE(of_awake.size() == kGroups * awake.size());
    for (std::size_t i = 0; i < awake.size(); ++i)
        for (std::size_t g = 0; g < kGroups; ++g)
            REQUIRE(of_awake[kGroups * i + g] ==
                    Rgb(static_cast<float>(awake[i].surface), static_cast<float>(g), 0));
}
