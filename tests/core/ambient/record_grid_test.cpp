#include "core/ambient/record_grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr double kAngle = 0.4;  ///< largest between normals [rad]

struct Found {
    double weight = 0;
    std::vector<RecordShare> shares;
};

Found find(const RecordGrid& grid, const Vec3& position, const Vec3& normal) {
    Found found;
    found.weight = grid.find(position, normal, found.shares);
    return found;
}

Vec3 somewhere(RandomStream& random, double wide) {
    return {wide * (random.next() - 0.5), wide * (random.next() - 0.5),
            wide * (random.next() - 0.5)};
}

}  // namespace

TEST_CASE("grid of records: a disk serves what is near, on its plane, and faces the same way") {
    RecordGrid grid({0, 0, 0}, 0.01, kAngle);
    grid.insert({{1, 2, 3}, {0, 0, 1}, 0.5, {}});
    CHECK(find(grid, {1, 2, 3}, {0, 0, 1}).weight == within(1e-6, 1));
    CHECK(find(grid, {1.25, 2, 3}, {0, 0, 1}).weight == within(1e-6, 0.5));
    CHECK(find(grid, {1, 1.51, 3}, {0, 0, 1}).shares.size() == 1);
    CHECK(find(grid, {1, 1.49, 3}, {0, 0, 1}).shares.empty());
    CHECK(find(grid, {1, 2, 3.1}, {0, 0, 1}).shares.empty());  // another floor
    CHECK(find(grid, {1, 2, 2.9}, {0, 0, 1}).shares.empty());
    CHECK(find(grid, {1, 2, 3}, {0, std::sin(0.39), std::cos(0.39)}).shares.size() == 1);
    CHECK(find(grid, {1, 2, 3}, {0, std::sin(0.41), std::cos(0.41)}).shares.empty());
    CHECK(find(grid, {1, 2, 3}, {0, 0, -1}).shares.empty());
}

TEST_CASE("grid of records: small disks keep large ones out, where they weigh enough") {
    RecordGrid grid({0, 0, 0}, 0.01, kAngle);
    grid.insert({{0, 0, 0}, {0, 0, 1}, 4, {}});
    grid.insert({{1, 0, 0}, {0, 0, 1}, 0.1, {}});
    const Found small = find(grid, {1.01, 0, 0}, {0, 0, 1});
    REQUIRE(small.shares.size() == 1);
    CHECK(small.shares[0].record == 1);
    const Found both = find(grid, {1.099, 0, 0}, {0, 0, 1});
    CHECK(both.shares.size() == 2);
    const Found large = find(grid, {1.2, 0, 0}, {0, 0, 1});
    REQUIRE(large.shares.size() == 1);
    CHECK(large.shares[0].record == 0);
}

TEST_CASE("grid of records: it finds what a search of all finds, far from the origin as well") {
    const Vec3 origin{500000, -4000000, 100};
    RecordGrid grid(origin, 0.01, kAngle);
    RandomStream random(7);
    std::vector<CoefficientRecord> all;
    for (int i = 0; i < 500; ++i) {
        // Of one size, lest one keep another out.
        const CoefficientRecord record{origin + somewhere(random, 4),
                                       normalize(somewhere(random, 1)),
                                       0.55 + 0.08 * random.next(),
                                       {}};
        all.push_back(record);
        grid.insert(record);
    }
    CHECK(grid.size() == all.size());
    std::size_t served = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 at = origin + somewhere(random, 4), normal = normalize(somewhere(random, 1));
        const Found found = find(grid, at, normal);
        std::size_t expected = 0;
        for (const CoefficientRecord& record : all) {
            const Vec3 offset = at - record.position;
            const double cosine = dot(normal, record.normal);
            if (length(offset) < record.reach && cosine > std::cos(kAngle) &&
                std::abs(dot(offset, record.normal)) < 0.15 * record.reach)
                ++expected;
        }
        CHECK(found.shares.size() == expected);
        served += expected;
    }
    CHECK(served > 50);
}
