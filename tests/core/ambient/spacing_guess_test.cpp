#include "core/ambient/spacing_guess.h"

#include <doctest/doctest.h>

#include "core/math/direction_code.h"
#include "core/math/random.h"

using namespace lightwalk;

namespace {

AmbientLimits limits() {
    AmbientLimits limits;
    limits.size = 8;
    limits.accuracy = 0.5;
    limits.least_radius = 0.1;
    limits.most_radius = 3.2;
    return limits;
}

AmbientRecord record_at(const Vec3& p, const Vec3& normal, float radius, int level = 0) {
    AmbientRecord record;
    for (std::size_t k = 0; k < 3; ++k) record.position[k] = static_cast<float>(p[k]);
    record.normal = encode_direction(normal);
    record.radius = {radius, radius};
    record.level = static_cast<std::uint8_t>(level);
    return record;
}

AmbientQuery query_at(const Vec3& p, const Vec3& normal, int level = 0) {
    return {p, normal, normal, level, 1};
}

}  // namespace

TEST_CASE("a spacing is guessed from the nearest values of the same level and side") {
    const Vec3 up{0, 0, 1};
    SpacingGuess guess(limits());
    CHECK(guess(query_at({1, 1, 1}, up)) == doctest::Approx(1.6));  // nothing is known
    guess.add(record_at({1.01, 1.01, 1.01}, up, 0.2f));
    CHECK(guess(query_at({1.02, 1.02, 1.02}, up)) == doctest::Approx(0.1));
    CHECK(guess(query_at({1.02, 1.02, 1.02}, {0, 0.6, 0.8})) == doctest::Approx(0.1));
    CHECK(guess(query_at({1.02, 1.02, 1.02}, {0, 0, -1})) == doctest::Approx(1.6));
    CHECK(guess(query_at({1.02, 1.02, 1.02}, up, 1)) == doctest::Approx(1.6));
    CHECK(guess(query_at({7, 7, 7}, up)) == doctest::Approx(1.6));
    guess.add(record_at({2.9, 2.9, 2.9}, up, 0.8f));
    CHECK(guess(query_at({1.02, 1.02, 1.02}, up)) == doctest::Approx(0.1));
    CHECK(guess(query_at({2.92, 2.92, 2.92}, up)) == doctest::Approx(0.4));
    CHECK(guess(query_at({1.4, 2, 1}, up)) == doctest::Approx(0.2));  // their geometric mean
}

TEST_CASE("chosen points reach as far as they were told to, and no farther") {
    RandomStream random(7);
    ApartSet set(0.05, 1.6);
    struct Chosen {
        AmbientQuery query;
        double reach;
    };
    std::vector<Chosen> chosen;
    const Vec3 up{0, 0, 1}, side{0, 1, 0};
    int reached = 0;
    for (int i = 0; i < 2000; ++i) {
        const AmbientQuery query =
            query_at({8 * random.next() - 4, 8 * random.next() - 4, random.next() - 0.5},
                     random.next() < 0.5 ? up : side);
        bool expected = false;
        for (const Chosen& c : chosen) {
            expected = expected || (c.query.normal == query.normal &&
                                    length(c.query.position - query.position) < c.reach);
        }
        REQUIRE(set.reached(query) == expected);
        reached += expected ? 1 : 0;
        const double reach = 0.05 * std::pow(32, random.next());
        if (expected || chosen.size() > 60) continue;
        chosen.push_back({query, reach});
        set.add(query, reach);
    }
    CHECK(reached > 200);
    CHECK(reached < 1800);
}
