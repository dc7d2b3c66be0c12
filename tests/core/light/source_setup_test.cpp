#include "core/light/source_setup.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/light/light_sources.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kSquareLamp = "void light lamp\n0\n0\n3 10 20 30\n";

/// The only source of a scene with this surface.
LightSource only_source(const std::string& surface, const std::string& material = kSquareLamp) {
    TestScene scene(material + surface);
    REQUIRE(scene.tracer.lights().all().size() == 1);
    return scene.tracer.lights()[0];
}

std::string error_of(const std::string& text) {
    try {
        TestScene scene(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

bool warns(const std::string& text, const std::string& part) {
    TestScene scene(text);
    for (const std::string& message : scene.warnings.messages) {
        if (message.find(part) != std::string::npos) return true;
    }
    return false;
}

void check_near(const Vec3& a, const Vec3& b) {
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(length(a - b) < kRounding);
}

}  // namespace

TEST_CASE(
    "light source of a quadrilateral: half edges from the first vertex, area, farthest vertex") {
    const LightSource s = only_source("lamp polygon p\n0\n0\n12 0 0 2  4 0 2  4 2 2  0 2 2\n");
    CHECK(s.is_flat());
    CHECK_FALSE(s.is_round());
    check_near(s.center, {2, 1, 2});
    check_near(s.u, {2, 0, 0});
    check_near(s.v, {0, 1, 0});
    check_near(s.normal, {0, 0, 1});
    CHECK(s.size == rounded(8));
    CHECK(s.radius == rounded(std::sqrt(5.0)));
    CHECK(s.uniform);
    CHECK(s.radiance == Rgb{10, 20, 30});
}

TEST_CASE("light source of a triangle: the square that touches its nearest edge") {
    const LightSource s = only_source("lamp polygon p\n0\n0\n9 0 0 0  6 0 0  0 4 0\n");
    check_near(s.center, {2, 4.0 / 3, 0});
    // Distances of the centre: 4/3 to y = 0, 2 to x = 0, less to the hypotenuse: (24 - 4·2 - 6·4/3)
    // / √52.
    const double nearest = 8 / std::sqrt(52.0);
    CHECK(length(s.u) == rounded(nearest));
    CHECK(length(s.v) == rounded(nearest));
    CHECK(std::abs(dot(normalize(s.u), normalize(Vec3{-6, 4, 0}))) == rounded(1));
    CHECK(s.size == rounded(12));
    CHECK(warns(kSquareLamp + "lamp polygon p\n0\n0\n9 0 0 0  60 0 0  0 1 0\n",
                "test.rad:5: polygon \"p\": source aspect"));
}

TEST_CASE("light source of another polygon or a ring: a square of its area about the normal") {
    const LightSource p =
        only_source("lamp polygon p\n0\n0\n15 1 0 0  2 1 0  1 2 0  0 2 0  -1 1 0\n");
    CHECK(4 * length(p.u) * length(p.v) == rounded(static_cast<double>(p.size)));
    CHECK(dot(p.u, p.v) == rounded(0));
    const LightSource r = only_source("lamp ring r\n0\n0\n8 1 2 3  0 0 -1  0 .5\n");
    CHECK(r.is_round());
    check_near(r.normal, {0, 0, -1});
    CHECK(r.size == rounded(kPi * 0.25));
    CHECK(4 * length(r.u) * length(r.v) == rounded(kPi * 0.25));
    check_near(cross(r.normal, r.u), r.v);
    check_near(normalize(r.u), perpendicular(r.normal));
    CHECK(r.radius == 0.5f);
}

TEST_CASE("light source of a sphere, a cylinder and a cone of directions") {
    const LightSource s = only_source("lamp sphere s\n0\n0\n4 1 2 3 .5\n");
    check_near(s.u, {kSphereBox * 0.5, 0, 0});
    check_near(s.w, {0, 0, kSphereBox * 0.5});
    CHECK(s.size == rounded(kPi * 0.25));
    const LightSource c = only_source("lamp cylinder c\n0\n0\n7 0 0 1  4 0 1  .1\n");
    CHECK(c.is_cylinder());
    CHECK_FALSE(c.is_round());
    check_near(c.center, {2, 0, 1});
    check_near(c.u, {2, 0, 0});
    CHECK(length(c.v) == printed(4, 0.08559));
    CHECK(length(c.w) == printed(4, 0.08559));
    CHECK(c.size == rounded(2 * 0.1 * 4));
    CHECK(c.radius == rounded(2));
    const LightSource d = only_source("lamp source sun\n0\n0\n4 0 0 5 30\n");
    CHECK(d.is_distant());
    check_near(d.center, {0, 0, 1});
    const double omega = 2 * kPi * (1 - std::cos(15 * kPi / 180));
    CHECK(d.size == rounded(omega));
    CHECK(4 * length(d.u) * length(d.v) == float_rounded(omega));
    CHECK(d.radius == rounded(std::sqrt(omega / kPi)));
    CHECK(warns(kSquareLamp + "lamp cylinder c\n0\n0\n7 0 0 1  1 0 1  .3\n",
                "source aspect too small"));
}

TEST_CASE(
    "which materials light: glow by its radius, illum, spotlight, black and void ones do not") {
    const std::string ball = " sphere s\n0\n0\n4 0 0 1 .5\n";
    const auto count = [](const std::string& text) {
        return TestScene(text).tracer.lights().all().size();
    };
    CHECK(count("void glow g\n0\n0\n4 1 1 1 3\ng" + ball) == 1);
    CHECK(count("void glow g\n0\n0\n4 1 1 1 0\ng" + ball) == 0);
    CHECK(count("void glow g\n0\n0\n4 1 1 1 -1\ng" + ball) == 0);
    CHECK(count("void light l\n0\n0\n3 0 1e-7 0\nl" + ball) == 0);
    CHECK(count("void plastic l\n0\n0\n5 1 1 1 0 0\nl" + ball) == 0);
    CHECK(count("void" + ball) == 0);
    CHECK(count("void light l\n0\n0\n3 0 1e-7 0\nl cone c\n0\n0\n8 0 0 0 0 0 1 .1 .2\n") == 0);
    TestScene sky("void glow g\n0\n0\n4 1 1 1 0\ng source s\n0\n0\n4 0 0 1 180\n");
    REQUIRE(sky.tracer.lights().all().size() == 1);
    CHECK(sky.tracer.lights()[0].unusable);
    CHECK(sky.tracer.lights().sampled().empty());
    const LightSource illum =
        only_source(ball.substr(1).insert(0, "i "), "void illum i\n0\n0\n3 1 1 1\n");
    CHECK(illum.transparent_illum);
}

TEST_CASE("patterns make a source's radiance vary: no shortcut") {
    CHECK_FALSE(only_source("lamp sphere s\n0\n0\n4 0 0 1 .5\n",
                            "void brightfunc half\n2 .5 .\n0\n0\nhalf light lamp\n0\n0\n3 1 1 1\n")
                    .uniform);
    CHECK_FALSE(only_source("half sphere s\n0\n0\n4 0 0 1 .5\n",
                            "void light lamp\n0\n0\n3 1 1 1\nlamp brightfunc half\n2 .5 .\n0\n0\n")
                    .uniform);
}

TEST_CASE("spotlights: cone, focal length, and a warning for those that shine backwards") {
    const std::string spot = "void spotlight s\n0\n0\n7 1 1 1 60 0 0 -2\n";
    const LightSource down = only_source("s ring r\n0\n0\n8 0 0 3 0 0 -1 0 .1\n", spot);
    REQUIRE(down.spot);
    check_near(down.spot->aim, {0, 0, -1});
    CHECK(down.spot->focal_length == 2);
    CHECK(down.spot->size == rounded(2 * kPi * (1 - std::cos(kPi / 6))));
    const std::string sideways =
        "void spotlight s\n0\n0\n7 1 1 1 10 1 0 .1\ns ring r\n0\n0\n8 0 0 3 0 0 -1 0 .1\n";
    CHECK(warns(sideways, "invalid spotlight direction"));
    CHECK(TestScene(sideways).tracer.lights().sampled().empty());
    CHECK(warns(spot + "s source sun\n0\n0\n4 0 0 1 5\n", "distant light source is a spotlight"));
}

TEST_CASE("surfaces that cannot emit: what is wrong, and where") {
    CHECK(error_of(kSquareLamp + "\nlamp cone c\n0\n0\n8 0 0 0 0 0 1 .1 .2\n") ==
          "test.rad:6: cone \"c\": illegal material \"lamp\": only source, sphere, polygon, ring "
          "and cylinder can be "
          "light sources");
    CHECK(error_of(kSquareLamp + "lamp bubble b\n0\n0\n4 0 0 0 1\n").find("illegal material") !=
          std::string::npos);
    CHECK(
        error_of(kSquareLamp + "lamp tube t\n0\n0\n7 0 0 0 0 0 1 .1\n").find("illegal material") !=
        std::string::npos);
    CHECK(error_of(kSquareLamp + "lamp ring r\n0\n0\n8 0 0 0 0 0 1 .1 .2\n")
              .find("test.rad:5: ring \"r\": cannot hit") == 0);
    CHECK(error_of(kSquareLamp + "lamp polygon p\n0\n0\n18 0 0 0 9 0 0 9 9 0 8 9 0 8 1 0 0 1 0\n")
              .find("cannot hit source center") != std::string::npos);
    CHECK(error_of(kSquareLamp + "lamp source s\n0\n0\n4 0 0 0 5\n").find("zero direction") !=
          std::string::npos);
    CHECK(error_of(kSquareLamp + "lamp source s\n0\n0\n4 0 0 1 1e-5\n").find("zero size") !=
          std::string::npos);
    CHECK(error_of("void spotlight s\n0\n0\n7 1 1 1 0 0 0 1\ns sphere b\n0\n0\n4 0 0 0 1\n")
              .find("zero angle") != std::string::npos);
    CHECK(
        error_of("void light l\n0\n0\n2 1 1\nl sphere b\n0\n0\n4 0 0 0 1\n").find("test.rad:1: ") ==
        0);
}
