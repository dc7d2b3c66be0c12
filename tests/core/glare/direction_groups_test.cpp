#include "core/glare/direction_groups.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace lightwalk;

namespace {

Vec3 at_degrees(double right, double up) {
    const double x = right * kPi / 180, y = up * kPi / 180;
    return {std::sin(x) * std::cos(y), std::cos(x) * std::cos(y), std::sin(y)};
}

/// By the definition: whoever is near takes over the smaller number, until nothing changes.
std::vector<std::uint32_t> plain_groups(const std::vector<Vec3>& directions, double angle) {
    std::vector<std::uint32_t> names(directions.size());
    for (std::uint32_t i = 0; i < names.size(); ++i) names[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < names.size(); ++i) {
            for (std::size_t j = 0; j < names.size(); ++j) {
                const double far = length(directions[i] - directions[j]);
                if (names[j] < names[i] && far <= 2 * std::sin(angle / 2))
                    names[i] = names[j], changed = true;
            }
        }
    }
    std::vector<std::uint32_t> groups(names.size());
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < groups.size(); ++i)
        groups[i] = names[i] == i ? count++ : groups[names[i]];
    return groups;
}

}  // namespace

TEST_CASE("groups of directions: steps up to the angle join, longer ones do not") {
    const std::vector<Vec3> chain{at_degrees(0, 0), at_degrees(20, 0), at_degrees(5, 0),
                                  at_degrees(10, 0), at_degrees(26, 0)};
    using Groups = std::vector<std::uint32_t>;
    CHECK(group_directions(chain, 5.1 * kPi / 180) == Groups{0, 1, 0, 0, 2});
    CHECK(group_directions(chain, 6.1 * kPi / 180) == Groups{0, 1, 0, 0, 1});
    CHECK(group_directions(chain, 4.9 * kPi / 180) == Groups{0, 1, 2, 3, 4});
    CHECK(group_directions(chain, 10.1 * kPi / 180) == Groups{0, 0, 0, 0, 0});
    CHECK(group_directions({}, 0.1).empty());
}

TEST_CASE("groups of directions: as by the definition, wherever the grid's cells lie") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(-1, 1);
    for (const double angle : {0.02, 0.1, 0.3, 1.2}) {
        for (const std::size_t count : {10u, 100u, 400u}) {
            CAPTURE(angle);
            CAPTURE(count);
            std::vector<Vec3> directions;
            while (directions.size() < count)
                directions.push_back(normalize({side(random), side(random), side(random)}));
            CHECK(group_directions(directions, angle) == plain_groups(directions, angle));
        }
    }
}
