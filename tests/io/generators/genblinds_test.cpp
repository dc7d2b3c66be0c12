#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/io/generators/generated.h"

namespace lightwalk {
namespace {

using test::generate;
using test::generator_error;
using test::kPrinted;
using test::near;
using test::polygon_normal;
using test::vertex;

}  // namespace

TEST_CASE("genblinds: flat slats, evenly spaced in height, tilted") {
    const auto blinds = generate("genblinds m b 2 10 6 3 30");
    REQUIRE(blinds.primitives.size() == 3);
    CHECK(test::names(blinds) == std::vector<std::string>{"b.1.0", "b.2.0", "b.3.0"});
    const double c = std::sqrt(3.0);
    CHECK(near(vertex(blinds.primitives[0], 0), {0, 0, 1}));
    CHECK(near(vertex(blinds.primitives[1], 1), {0, 10, 3}));
    CHECK(near(vertex(blinds.primitives[2], 2), {c, 10, 6}));
    CHECK(near(vertex(blinds.primitives[2], 3), {c, 0, 6}));
    CHECK(near(polygon_normal(generate("genblinds m b 2 10 6 1 0").primitives[0]), {0, 0, -1}));
}

TEST_CASE("genblinds: curved slats are arcs of the radius over the same depth") {
    for (const char* sign : {"+r", "-r"}) {
        const double radius = 2;
        const auto slat = generate(std::string("genblinds m b 2 10 0 1 20 ") + sign + " 2");
        CHECK(slat.primitives.size() == 20);  // 60 degrees in pieces of 3
        const Vec3 end = vertex(slat.primitives.back(), 3);
        CHECK(near(vertex(slat.primitives[0], 0), {0, 0, 0}));
        const double angle = 20 * kPi / 180;
        CHECK(near(end, {2 * std::cos(angle), 0, 2 * std::sin(angle)}));
        // the centre of the circle lies below an arched slat, above a sagging one
        const double side = sign[0] == '+' ? -1 : 1;
        const Vec3 up{-std::sin(angle), 0, std::cos(angle)};
        const Vec3 center = end / 2 + up * (side * std::sqrt(3.0));
        for (std::size_t k = 0; k < 20; ++k) {
            CHECK(slat.primitives[k].name == "b.1." + std::to_string(k));
            CHECK(std::abs(length(vertex(slat.primitives[k], 0) - center) - radius) < kPrinted);
            CHECK(near(vertex(slat.primitives[k], 2),
                       vertex(slat.primitives[k], 3) + Vec3{0, 10, 0}));
        }
    }
}

TEST_CASE("genblinds: pieces span at most 3 degrees") {
    // Depths of arcs of 60, 60.5 and 2 degrees, radius 2.
    CHECK(generate("genblinds m b 2 1 0 1 0 +r 2").primitives.size() == 20);
    CHECK(generate("genblinds m b 2.01510 1 0 1 0 +r 2").primitives.size() == 21);
    CHECK(generate("genblinds m b .06981 1 0 1 0 +r 2").primitives.size() == 1);
}

TEST_CASE("genblinds: a negative radius bends the other way, radius 0 does not bend") {
    const auto arched = generate("genblinds m b 2 10 6 2 20 +r 3");
    const auto sagging = generate("genblinds m b 2 10 6 2 20 -r -3");
    REQUIRE(arched.primitives.size() == sagging.primitives.size());
    for (std::size_t i = 0; i < arched.primitives.size(); ++i) {
        CHECK(arched.primitives[i].reals == sagging.primitives[i].reals);
    }
    CHECK(generate("genblinds m b 2 10 6 2 20 +r 0").primitives.size() == 2);
}

TEST_CASE("genblinds: mistakes") {
    CHECK(generator_error("genblinds m b 2 10 6 3").find("usage: genblinds") != std::string::npos);
    CHECK(generator_error("genblinds m b 2 10 6 3 30 -r") != "");
    CHECK(generator_error("genblinds m b 2 10 6 3 30 -q 4").find("unknown option \"-q\"") !=
          std::string::npos);
    CHECK(generator_error("genblinds m b 2 10 6 3 30 -r 4 5") != "");
    CHECK(generator_error("genblinds m b 2 10 6 0 30") != "");
    CHECK(generator_error("genblinds m b 2 10 6 3000000000 30") != "");
    CHECK(generator_error("genblinds m b 2 10 6 4000000 30 -r 1.5").find("too many slats") !=
          std::string::npos);
    CHECK(generator_error("genblinds m b 2 10 6 3 30 -r .5").find("does not fit") !=
          std::string::npos);
}

}  // namespace lightwalk
