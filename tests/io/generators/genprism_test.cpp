#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tests/io/generators/generated.h"
#include "tests/temporary_folder.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::generate;
using test::Generated;
using test::generator_error;
using test::kPrinted;
using test::names;
using test::near;
using test::polygon_normal;
using test::rounded;
using test::vertex;

const std::string kClockwise = "genprism m p 4 0 0 0 2 3 2 3 0";

Vec3 center_of(const PrimitiveText& polygon) {
    Vec3 sum;
    const std::size_t n = polygon.reals.size() / 3;
    for (std::size_t i = 0; i < n; ++i) sum += vertex(polygon, i);
    return sum / static_cast<double>(n);
}

const PrimitiveText& named(const Generated& generated, const std::string& name) {
    for (const PrimitiveText& primitive : generated.primitives) {
        if (primitive.name == name) return primitive;
    }
    FAIL("nothing is named " << name);
    return generated.primitives.front();
}

}  // namespace

TEST_CASE("genprism: bottom, top and sides, normals outward for a clockwise polygon") {
    for (const char* extrusion : {" -l 0 0 5", " -l 1 .5 5"}) {
        const auto prism = generate(kClockwise + extrusion);
        CHECK(names(prism) == std::vector<std::string>{"p.b", "p.t", "p.1", "p.2", "p.3", "p.4"});
        Vec3 middle;
        for (const PrimitiveText& face : prism.primitives) middle += center_of(face) / 6;
        for (const PrimitiveText& face : prism.primitives) {
            CHECK(face.modifier == "m");
            CHECK(dot(polygon_normal(face), center_of(face) - middle) > 0);
        }
    }
    const auto prism = generate(kClockwise);
    CHECK(vertex(prism.primitives[0], 1) == Vec3{0, 2, 0});
    CHECK(vertex(prism.primitives[1], 0) == Vec3{3, 0, 1});
    CHECK(vertex(prism.primitives[2], 2) == Vec3{0, 2, 1});
    CHECK(vertex(prism.primitives[2], 3) == Vec3{0, 2, 0});
}

TEST_CASE("genprism: -c and -e leave parts out, twice brings them back") {
    CHECK(names(generate(kClockwise + " -e -c")) == std::vector<std::string>{"p.1", "p.2", "p.3"});
    CHECK(names(generate(kClockwise + " -c")).size() == 5);
    CHECK(names(generate(kClockwise + " -c -c -e -e")).size() == 6);
}

TEST_CASE("genprism: vertices from a file and from standard input") {
    const test::TemporaryFolder folder;
    folder.write("base", "0 0\n0 2  3 2\n3 0\n");
    const auto inline_base = generate(kClockwise);
    const auto from_file = generate("genprism m p base", {folder.path(), ""});
    const auto from_input = generate("genprism m p -", {"", "0 0 0 2 3 2 3 0"});
    REQUIRE(from_file.primitives.size() == inline_base.primitives.size());
    REQUIRE(from_input.primitives.size() == inline_base.primitives.size());
    for (std::size_t i = 0; i < inline_base.primitives.size(); ++i) {
        CHECK(from_file.primitives[i].reals == inline_base.primitives[i].reals);
        CHECK(from_input.primitives[i].reals == inline_base.primitives[i].reals);
    }
}

TEST_CASE("genprism: a rounded box is a box with its edges replaced by cylinders and spheres") {
    const auto box = generate(kClockwise + " -l 0 0 5 -r .5");
    std::map<std::string, int> count;
    for (const PrimitiveText& part : box.primitives) ++count[part.type_word];
    CHECK(count["polygon"] == 6);
    CHECK(count["cylinder"] == 12);
    CHECK(count["sphere"] == 8);
    CHECK(names(box)[2] == "p.bc1");
    CHECK(names(box)[3] == "p.be1");
    for (const PrimitiveText& part : box.primitives) {
        if (part.type_word == "polygon") continue;
        // every rounding's axis keeps the radius to the faces
        for (std::size_t end = 0; end < (part.reals.size() > 4 ? 2 : 1); ++end) {
            const Vec3 p = vertex(part, end);
            CHECK(std::min(p.x, 3 - p.x) == rounded(0.5));
            CHECK(std::min(p.y, 2 - p.y) == rounded(0.5));
            CHECK(std::min(p.z, 5 - p.z) == rounded(0.5));
        }
        CHECK(part.reals.back() == 0.5);
    }
    const PrimitiveText& bottom = named(box, "p.b");
    CHECK(near(vertex(bottom, 0), {0.5, 0.5, 0}));
    const PrimitiveText& side = named(box, "p.1");
    CHECK(near(vertex(side, 0), {0, 0.5, 0.5}));
    CHECK(near(vertex(side, 2), {0, 1.5, 4.5}));
}

TEST_CASE("genprism: the corners of rounded sides lie one radius off the roundings' centres") {
    const std::string corner = "genprism m p 6 0 0 0 4 2 4 2 2 5 2 5 0 -r .2 -l ";
    for (const char* extrusion : {"0 0 2", "0 0 -2", ".8 0 2", "-.3 .7 3", ".5 .3 -2"}) {
        CAPTURE(extrusion);
        const auto prism = generate(corner + extrusion);
        for (int i = 1; i <= 6; ++i) {
            CAPTURE(i);
            const std::string own = std::to_string(i);
            const std::string next = std::to_string(i % 6 + 1);
            const PrimitiveText& side = named(prism, "p." + own);
            const std::array<Vec3, 4> centers = {
                vertex(named(prism, "p.be" + own), 1), vertex(named(prism, "p.te" + own), 1),
                vertex(named(prism, "p.te" + next), 1), vertex(named(prism, "p.be" + next), 1)};
            for (std::size_t k = 0; k < 4; ++k) {
                const Vec3 offset = vertex(side, k) - centers[k];
                CHECK(std::abs(length(offset) - 0.2) < kPrinted);
                CHECK(std::abs(dot(offset, centers[3] - centers[0])) < 10 * kPrinted);
            }
        }
    }
}

TEST_CASE("genprism: faces of upright and downward prisms touch their roundings") {
    // Downward, the order that makes normals outward is the other one.
    for (const char* shape : {"0 0 0 2 3 2 3 0 -l 0 0 2", "0 0 3 0 3 2 0 2 -l 0 0 -2"}) {
        const auto prism = generate("genprism m p 4 " + std::string(shape) + " -r .2");
        for (std::size_t i = 1; i <= 4; ++i) {
            const PrimitiveText& side = named(prism, "p." + std::to_string(i));
            const PrimitiveText& edge = named(prism, "p.e" + std::to_string(i));
            for (std::size_t end = 0; end < 2; ++end) {
                const Vec3 offset = vertex(side, 0) - vertex(edge, end);
                CHECK(dot(offset, polygon_normal(side)) == rounded(0.2));
            }
        }
    }
}

TEST_CASE("genprism: inner corners have no spheres") {
    const auto corner = generate("genprism m p 6 0 0 0 2 1 2 1 1 2 1 2 0 -r .1");
    int spheres = 0;
    for (const PrimitiveText& part : corner.primitives)
        spheres += part.type_word == "sphere" ? 1 : 0;
    CHECK(spheres == 2 * 5);
}

TEST_CASE("genprism: mistakes") {
    CHECK(generator_error("genprism m p 2 0 0 1 1").find("usage: genprism") != std::string::npos);
    CHECK(generator_error("genprism m p 1025 0 0 1 1").find("1024") != std::string::npos);
    CHECK(generator_error("genprism m p 3 0 0 1 1 1") != "");
    CHECK(generator_error("genprism m p no_such_file").find("no_such_file") != std::string::npos);
    CHECK(generator_error("genprism m p -", {"", "0 0 1 1\n2"}) != "");
    CHECK(generator_error("genprism m p -", {"", "0 0 1 1\n2 b"}).find("standard input:2") !=
          std::string::npos);
    CHECK(generator_error(kClockwise + " -l 1 1 0").find("z is zero") != std::string::npos);
    CHECK(generator_error(kClockwise + " -r 1.5").find("radius") != std::string::npos);
    CHECK(generator_error(kClockwise + " -q").find("unknown option \"-q\"") != std::string::npos);
    CHECK(generator_error("genprism m p 4 0 0 0 2 0 2 3 0 -r .1").find("the same") !=
          std::string::npos);
    CHECK(generator_error("genprism m p 3 0 0 2 0 1 0 -r .1").find("lie on each other") !=
          std::string::npos);
    std::string many;
    for (int i = 0; i < 1030; ++i) many += std::to_string(i) + " 0 ";
    CHECK(generator_error("genprism m p -", {"", many}) != "");
}

}  // namespace lightwalk
