// The boxes that keep lookups out of parts of the ambient cache: never wrong, seldom vague.
#include "parallel/reach_box.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/math/random.h"

namespace lightwalk {
namespace {

const CachePath kCube{{-1, 2, 5}, 0.5};

Vec3 random_place(RandomStream& random) {  // in the cube and as far again on either side
    return {-1.5 + 1.5 * random.next(), 1.5 + 1.5 * random.next(), 4.5 + 1.5 * random.next()};
}

bool holds(const ReachBox& box, const Vec3& p) {
    const ReachGrid grid(kCube);
    return box.holds(ReachBox::place(grid.step(0, p.x), grid.step(1, p.y), grid.step(2, p.z)));
}

}  // namespace

TEST_CASE("a reach box holds what it grew by, and little else") {
    RandomStream random(5);
    int inside = 0, outside = 0;
    for (int i = 0; i < 2000; ++i) {
        ReachBox box;
        const Vec3 a = random_place(random), b = random_place(random);
        Vec3 low, high;
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(a[k], b[k]);
            high[k] = std::max(a[k], b[k]);
        }
        REQUIRE_FALSE(holds(box, a));
        box.grow(ReachGrid(kCube), low, low);
        box.grow(ReachGrid(kCube), high, high);
        for (int j = 0; j < 50; ++j) {
            const Vec3 p = random_place(random);
            bool within = true, beyond = false;
            constexpr double kStep = 1.5 / 127;
            for (std::size_t k = 0; k < 3; ++k) {
                within = within && p[k] >= low[k] && p[k] <= high[k];
                beyond = beyond || p[k] < low[k] - kStep || p[k] > high[k] + kStep;
            }
            if (within) REQUIRE(holds(box, p));
            if (beyond) REQUIRE_FALSE(holds(box, p));
            inside += within ? 1 : 0;
            outside += beyond ? 1 : 0;
        }
    }
    CHECK(inside > 2000);
    CHECK(outside > 20000);
}

TEST_CASE("a reach box of vast bounds holds every place") {
    ReachBox box;
    box.grow(ReachGrid(kCube), {-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300});
    RandomStream random(6);
    for (int i = 0; i < 100; ++i) REQUIRE(holds(box, random_place(random)));
}

}  // namespace lightwalk
