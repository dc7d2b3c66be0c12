#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/function/environment.h"
#include "tests/io/generators/generated.h"
#include "tests/temporary_folder.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::generate;
using test::generator_error;
using test::near;
using test::polygon_normal;
using test::rounded;
using test::vertex;

/// The perturbation that a "Phong" texture of gensurf gives at `p`, from the library's function
/// file.
Vec3 perturbation(const PrimitiveText& texture, const Vec3& p) {
    FunctionEnvironment environment;
    environment.load("surf.cal", read_file(LIGHTWALK_SOURCE "/io/library/surf.cal"));
    std::array<ExpressionRequest, 3> requests;
    for (std::size_t i = 0; i < 3; ++i) requests[i].text = texture.strings.at(i);
    const Program program =
        environment.compile("surf.cal", requests, texture.reals, 0, {"test.rad", 1});
    ChannelValues channels{};
    for (std::size_t i = 0; i < 3; ++i) channels[static_cast<std::size_t>(Channel::Px) + i] = p[i];
    EvalState state;
    program.begin(state, channels);
    return {program.evaluate(0, state), program.evaluate(1, state), program.evaluate(2, state)};
}

}  // namespace

TEST_CASE("gensurf: flat cells are one polygon with the normal of (s,t)") {
    const auto plane = generate("gensurf paint floor s t 0 2 3");
    CHECK(plane.text.starts_with("# gensurf paint floor s t 0 2 3\n"));
    REQUIRE(plane.primitives.size() == 6);
    for (const PrimitiveText& cell : plane.primitives) {
        CHECK(cell.type_word == "polygon");
        CHECK(cell.modifier == "paint");
        CHECK(cell.reals.size() == 12);
        CHECK(near(polygon_normal(cell), {0, 0, 1}));
    }
    CHECK(plane.primitives[0].name == "floor.1");
    CHECK(plane.primitives[5].name == "floor.6");
    // i is the outer loop: the second cell is one step along t, where rows alternate their cuts.
    CHECK(vertex(plane.primitives[0], 0) == Vec3{0.5, 0, 0});
    CHECK(near(vertex(plane.primitives[1], 0), {0, 1. / 3, 0}));
    const auto back = generate("gensurf paint floor s t 0 2 3 -i");
    CHECK(near(polygon_normal(back.primitives[0]), {0, 0, -1}));
}

TEST_CASE("gensurf: bent cells are two triangles, degenerate ones are dropped") {
    const auto saddle = generate("gensurf m s s t 's*t' 1 1");
    REQUIRE(saddle.primitives.size() == 2);
    // j even: B E A C, so triangles B E A and A E C
    CHECK(vertex(saddle.primitives[0], 0) == Vec3{1, 0, 0});
    CHECK(vertex(saddle.primitives[0], 1) == Vec3{1, 1, 1});
    CHECK(vertex(saddle.primitives[0], 2) == Vec3{0, 0, 0});
    CHECK(vertex(saddle.primitives[1], 2) == Vec3{0, 1, 0});
    const auto fan = generate("gensurf m f 's*cos(t)' 's*sin(t)' 0 1 1");
    CHECK(fan.primitives.size() == 1);
}

TEST_CASE("gensurf: points that are not valid take their triangles with them") {
    const auto corner = generate("gensurf m s s t 0 1 1 -e 'valid(s,t)=1.5-s-t'");
    REQUIRE(corner.primitives.size() == 1);
    CHECK(corner.primitives[0].reals.size() == 9);
    CHECK(near(polygon_normal(corner.primitives[0]), {0, 0, 1}));
    const auto other = generate("gensurf m s s t 0 1 1 -e 'valid(s,t)=.5+s-t'");
    REQUIRE(other.primitives.size() == 1);
    for (std::size_t i = 0; i < 3; ++i) CHECK(vertex(other.primitives[0], i) != Vec3{0, 1, 0});
    const auto none = generate("gensurf m s s t 0 2 2 -e 'valid(s,t)=-1'");
    CHECK(none.primitives.empty());
}

TEST_CASE("gensurf: smoothing bends the flat normal to the surface's at every vertex") {
    const std::string sphere =
        "gensurf m ball 'sin(PI*(.1+.8*s))*cos(2*PI*t)' 'sin(PI*(.1+.8*s))*sin(2*PI*t)' "
        "'cos(PI*(.1+.8*s))' 24 48 -s";
    const auto ball = generate(sphere);
    REQUIRE(ball.primitives.size() % 2 == 0);
    for (std::size_t i = 0; i < ball.primitives.size(); i += 58) {
        const PrimitiveText& texture = ball.primitives[i];
        const PrimitiveText& polygon = ball.primitives[i + 1];
        CHECK(texture.type_word == "texfunc");
        CHECK(texture.name == "Phong");
        CHECK(texture.modifier == "m");
        CHECK(texture.strings ==
              std::vector<std::string>{"surf_dx", "surf_dy", "surf_dz", "surf.cal"});
        CHECK(texture.reals.size() == 13);
        CHECK(polygon.modifier == "Phong");
        const Vec3 flat = polygon_normal(polygon);
        for (std::size_t k = 0; k < polygon.reals.size() / 3; ++k) {
            const Vec3 p = vertex(polygon, k);
            const Vec3 bent = normalize(flat + perturbation(texture, p));
            CHECK(near(bent, normalize(p), 2e-3));
            CHECK(dot(flat, normalize(p)) < 1 - 1e-4);  // the flat normal is not good enough
        }
    }
    const auto inside = generate(sphere + " -i");
    const Vec3 p = vertex(inside.primitives[301], 0);
    const Vec3 flat = polygon_normal(inside.primitives[301]);
    CHECK(near(normalize(flat + perturbation(inside.primitives[300], p)), -normalize(p), 2e-3));
}

TEST_CASE("gensurf: tables of heights and of points") {
    const test::TemporaryFolder folder;
    folder.write("heights.dat", "0 1 2\n10 11 12\n");
    const auto heights = generate("gensurf m s s t heights.dat 2 1", {folder.path(), ""});
    REQUIRE(heights.primitives.size() == 2);
    CHECK(vertex(heights.primitives[0], 0) == Vec3{0.5, 0, 1});
    CHECK(vertex(heights.primitives[0], 1) == Vec3{0.5, 1, 11});

    const auto points = generate("gensurf m s - - - 1 1", {"", "0 0 5  3 0 5\n0 4 5  3 4 5"});
    REQUIRE(points.primitives.size() == 1);
    CHECK(vertex(points.primitives[0], 0) == Vec3{3, 0, 5});

    // Values at centres of cells go on linearly to the edge.
    const auto centres = generate("gensurf m s s t - 2 2", {"", "1 2 3 4"});
    bool found = false;
    for (const PrimitiveText& cell : centres.primitives) {
        for (std::size_t i = 0; i < cell.reals.size() / 3; ++i) {
            const Vec3 p = vertex(cell, i);
            CHECK(p.z == rounded(0.5 + 2 * p.x - 0.5 + 4 * p.y - 0.5));
            found = true;
        }
    }
    CHECK(found);
}

TEST_CASE("gensurf: an object file has texture coordinates, and normals with -s") {
    const auto text = [](const std::string& command) {
        test::Silence sink;
        return test::generate_text(command, {}, sink);
    };
    const std::string plain = text("gensurf paint sheet s t 0 1 1 -o");
    CHECK(plain.find("usemtl paint\no sheet\n") != std::string::npos);
    CHECK(plain.find("v 1 1 0\nvt 1 1\n") != std::string::npos);
    CHECK(plain.find("f -2/-2 -1/-1 -3/-3 -4/-4\n") != std::string::npos);
    CHECK(plain.find("vn") == std::string::npos);
    const std::string smooth = text("gensurf paint sheet s t 0 1 1 -o -s");
    CHECK(smooth.find("vn 0 0 1\n") != std::string::npos);
    CHECK(smooth.find("f -2/-2/-2 -1/-1/-1") != std::string::npos);
}

TEST_CASE("gensurf: mistakes") {
    CHECK(generator_error("gensurf m s s t 0 1").find("usage: gensurf") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 0 .4 1").find("bad m") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 0 1 1e9").find("bad n") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 0 1e4 1e4").find("m times n") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 0 1 1 -q").find("unknown option") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 'frac(s)' 1 1").find("frac") != std::string::npos);
    CHECK(generator_error("gensurf m s s t 's+' 1 1") != "");
    CHECK(
        generator_error("gensurf m s s t - 2 2", {"", "1 2 3"}).find("bad number of data points") !=
        std::string::npos);
    CHECK(generator_error("gensurf m s s t - 1 1", {"", "1"}).find("at least 2 points") !=
          std::string::npos);
    CHECK(generator_error("gensurf m s s t - 1 1", {"", "1 2\n3 x"})
              .find("standard input:2: expected a number") != std::string::npos);
}

}  // namespace lightwalk
