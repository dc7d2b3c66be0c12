// Where light falls that is followed from its sources: chi-square tests in a closed sphere.
#include "core/light/light_walk.h"

#include <doctest/doctest.h>

#include "tests/core/chi_square.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A white sphere of radius 1 about the origin, seen from inside, with a tiny lamp in its middle.
std::string sphere_with(const std::string& lamp) {
    return "void light lamp 0 0 3 1 1 1\nvoid plastic white 0 0 5 1 1 1 0 0\n"
           "white bubble around 0 0 4 0 0 0 1\nlamp " +
           lamp;
}

/// Directions from the middle to the places that paths of three hits each meet first, second or
/// third.
std::vector<Vec3> directions(const std::string& lamp, std::size_t hit) {
    TestScene scene(sphere_with(lamp));
    const std::vector<Hit> places = walk_light(scene.tracer.lights(), scene.tracer, 60000);
    REQUIRE(places.size() == 60000);
    std::vector<Vec3> result;
    for (std::size_t i = hit; i < places.size(); i += 3)
        result.push_back(normalize(places[i].position));
    return result;
}

template <class Pdf>
ChiSquare compare(const std::vector<Vec3>& found, const Pdf& pdf) {
    std::size_t next = 0;
    return test_directions(
        {{0, 0, 1}, 1, 12, 16}, static_cast<int>(found.size()), 0,
        [&](RandomStream&) { return std::optional(found[next++]); }, pdf);
}

const std::string kWalkPanel =
    "polygon panel 0 0 12 -1e-4 -1e-4 0 1e-4 -1e-4 0 1e-4 1e-4 0 -1e-4 1e-4 0\n";
const std::string kBall = "sphere ball 0 0 4 0 0 0 1e-4\n";

double by_cosine(const Vec3& d) {
    return std::max(0.0, d.z) / kPi;
}
double uniform(const Vec3&) {
    return 1 / (4 * kPi);
}

}  // namespace

TEST_CASE("light walk: a panel sends by the cosine over its front, a ball everywhere alike") {
    const std::vector<Vec3> panel = directions(kWalkPanel, 0), ball = directions(kBall, 0);
    CHECK(agrees(compare(panel, by_cosine)));
    CHECK(!agrees(compare(panel, uniform)));
    CHECK(agrees(compare(ball, uniform)));
    CHECK(!agrees(compare(ball, by_cosine)));
}

TEST_CASE("light walk: what a white sphere reflects falls evenly on all of it") {
    for (const std::size_t hit : {std::size_t{1}, std::size_t{2}})
        CHECK(agrees(compare(directions(kWalkPanel, hit), uniform)));
}
