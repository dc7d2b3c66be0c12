#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/io/generators/generated.h"

namespace lightwalk {
namespace {

using test::generate;
using test::generator_error;
using test::kPrinted;
using test::vertex;

}  // namespace

TEST_CASE("genworm: spheres joined by cylinders where the radius is constant") {
    const auto worm = generate("genworm m w 2*t 0 0 .5 2");
    CHECK(test::names(worm) == std::vector<std::string>{"w.s0", "w.c1", "w.s1", "w.c2", "w.s2"});
    CHECK(worm.primitives[0].type_word == "sphere");
    CHECK(worm.primitives[1].type_word == "cylinder");
    CHECK(worm.primitives[1].reals == std::vector<double>{0, 0, 0, 1, 0, 0, 0.5});
    CHECK(worm.primitives[4].reals == std::vector<double>{2, 0, 0, 0.5});
}

TEST_CASE("genworm: a cone touches both spheres") {
    const auto worm = generate("genworm m w 0 3*t 4*t '2-1.5*t' 1");
    REQUIRE(worm.primitives.size() == 3);
    const PrimitiveText& cone = worm.primitives[1];
    CHECK(cone.type_word == "cone");
    const Vec3 axis{0, 0.6, 0.8};
    const Vec3 side{1, 0, 0};
    const Vec3 a = vertex(cone, 0) + side * cone.reals[6];
    const Vec3 b = vertex(cone, 1) + side * cone.reals[7];
    for (const auto& [center, radius, touch] :
         {std::tuple{Vec3{}, 2.0, a}, std::tuple{5 * axis, 0.5, b}}) {
        CHECK(std::abs(length(touch - center) - radius) < kPrinted);
        CHECK(std::abs(dot(touch - center, b - a)) < 10 * kPrinted);
    }
}

TEST_CASE("genworm: no joint between spheres in one place, or one inside the other") {
    CHECK(test::names(generate("genworm m w 1 2 3 1+t 2")) ==
          std::vector<std::string>{"w.s0", "w.s1", "w.s2"});
    const auto swallowed = generate("genworm m w t 0 0 '4-3*t' 1");
    for (const PrimitiveText& part : swallowed.primitives) {
        for (const double real : part.reals) CHECK(std::isfinite(real));
    }
}

TEST_CASE("genworm: mistakes") {
    CHECK(generator_error("genworm m w t 0 0 1").find("usage: genworm") != std::string::npos);
    CHECK(generator_error("genworm m w t 0 0 1 .2").find("at least 1") != std::string::npos);
    CHECK(generator_error("genworm m w t 0 0 1 1e12").find("at most") != std::string::npos);
    CHECK(generator_error("genworm m w 'y(t)' 0 0 1 2").find("y") != std::string::npos);
    CHECK(generator_error("genworm m w 't*1e200*1e200' 0 0 1 2") != "");
}

}  // namespace lightwalk
