#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/io/generators/closed_surface.h"
#include "tests/io/generators/library_file.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::enclosed_volume;
using test::generate;
using test::generator_error;
using test::is_closed;
using test::names;
using test::near;
using test::polygons;
using test::rounded;
using test::vertex;
using test::within;

constexpr Vec3 kSize{3, 4, 5};

/// A box whose edges are rounded exactly.
double rounded_volume(const Vec3& size, double r) {
    const Vec3 a = size - Vec3{2 * r, 2 * r, 2 * r};
    return a.x * a.y * a.z + 2 * r * (a.x * a.y + a.y * a.z + a.z * a.x) +
           kPi * r * r * (a.x + a.y + a.z) + 4. / 3 * kPi * r * r * r;
}

std::size_t count_of(const test::Generated& box, const std::string& type) {
    return static_cast<std::size_t>(
        std::ranges::count(box.primitives, type, &PrimitiveText::type_word));
}

}  // namespace

TEST_CASE("genbox: a plain box is closed, with outward normals, and named by its vertices") {
    const auto box = generate("genbox wood crate 3 4 5");
    CHECK(box.text.starts_with("# genbox wood crate 3 4 5\n"));
    CHECK(names(box) == std::vector<std::string>{"crate.1540", "crate.4620", "crate.2310",
                                                 "crate.3267", "crate.5137", "crate.6457"});
    CHECK(box.primitives[0].modifier == "wood");
    const PrimitiveText& front = box.primitives[0];
    CHECK(vertex(front, 0) == Vec3{3, 0, 0});
    CHECK(vertex(front, 1) == Vec3{3, 0, 5});
    CHECK(vertex(front, 2) == Vec3{0, 0, 5});
    CHECK(vertex(front, 3) == Vec3{0, 0, 0});
    CHECK(is_closed(polygons(box)));
    CHECK(enclosed_volume(polygons(box)) == rounded(60));
}

TEST_CASE("genbox -i: the same box seen from inside") {
    for (const char* options : {"", " -b .5"}) {
        const auto box = generate(std::string("genbox wood room 3 4 5 -i") + options);
        const auto outside = generate(std::string("genbox wood room 3 4 5") + options);
        CHECK(is_closed(polygons(box)));
        CHECK(enclosed_volume(polygons(box)) == rounded(-enclosed_volume(polygons(outside))));
        CHECK(names(box) == names(outside));
    }
}

TEST_CASE("genbox -b: edges and corners are cut off") {
    const auto box = generate("genbox wood crate 3 4 5 -b .5");
    const double b = 0.5;
    REQUIRE(box.primitives.size() == 26);
    CHECK(box.primitives[0].name == "crate.dhgc");
    CHECK(box.primitives[25].name == "crate.Trj");
    CHECK(is_closed(polygons(box)));
    const double edges = 4 * (kSize.x + kSize.y + kSize.z - 6 * b) * b * b / 2;
    const double corners = 8 * (b * b * b - b * b * b / 6);
    CHECK(enclosed_volume(polygons(box)) == rounded(60 - edges - corners));
}

TEST_CASE("genbox -r: faces, cylinders along the edges, spheres in the corners") {
    const auto box = generate("genbox wood crate 3 4 5 -r .5");
    CHECK(count_of(box, "polygon") == 6);
    REQUIRE(count_of(box, "cylinder") == 12);
    REQUIRE(count_of(box, "sphere") == 8);
    CHECK(box.primitives[6].name == "crate.st");
    CHECK(box.primitives[17].name == "crate.yz");
    CHECK(box.primitives[18].name == "crate.s");
    CHECK(box.primitives[25].name == "crate.z");
    double length_sum = 0;
    for (std::size_t i = 6; i < 18; ++i) {
        const PrimitiveText& edge = box.primitives[i];
        CHECK(edge.reals.at(6) == 0.5);
        length_sum += length(vertex(edge, 1) - vertex(edge, 0));
    }
    CHECK(length_sum == rounded(4 * (2 + 3 + 4)));
    CHECK(vertex(box.primitives[25], 0) == Vec3{2.5, 3.5, 4.5});
    // The last of -b and -r gives the amount; any -r rounds.
    CHECK(generate("genbox wood crate 3 4 5 -r .5 -b .25").primitives[6].reals.at(6) == 0.25);
}

TEST_CASE("genbox -r -n: flat pieces close up, and approach the rounded volume quadratically") {
    double last_error = 0;
    for (const int segments : {4, 8, 16}) {
        CAPTURE(segments);
        const auto box = generate("genbox wood crate 3 4 5 -r .5 -n " + std::to_string(segments));
        const auto n = static_cast<std::size_t>(segments);
        REQUIRE(box.primitives.size() == 6 + 12 * n + 8 * n * n);
        CHECK(box.primitives.back().name == "crate." + std::to_string(box.primitives.size()));
        CHECK(is_closed(polygons(box)));
        const double error = rounded_volume(kSize, 0.5) - enclosed_volume(polygons(box));
        CHECK(error > 0);
        if (last_error > 0) CHECK(last_error / error == within(0.05, 4));
        last_error = error;
    }
}

TEST_CASE("genbox -n: rounded up to a power of two, when boxes are segmented at all") {
    CHECK(generate("genbox m b 1 1 1 -r .1 -n 3").primitives.size() == 6 + 12 * 4 + 8 * 16);
    CHECK(count_of(generate("genbox m b 1 1 1 -r .1 -n 2"), "sphere") == 8);
    CHECK(count_of(generate("genbox m b 1 1 1 -r .1 -i -n 2"), "sphere") == 8);
    CHECK(count_of(generate("genbox m b 1 1 1 -r .1 -s"), "sphere") == 8);
    const auto inward = generate("genbox m b 3 4 5 -r .5 -i");
    CHECK(inward.primitives.size() == 6 + 12 * 32 + 8 * 32 * 32);
    CHECK(is_closed(polygons(inward)));
    CHECK(enclosed_volume(polygons(inward)) == within(1e-3, -rounded_volume(kSize, 0.5)));
}

TEST_CASE("genbox -s: tmesh.cal turns the flat normals into those of the rounded box") {
    const test::LibraryFile library = test::own_library_file("tmesh.cal");
    for (const char* options : {"-n 4", "-n 4 -i"}) {
        const auto box = generate(std::string("genbox wood crate 3 4 5 -r .5 -s ") + options);
        const double sign = std::string(options).ends_with("-i") ? -1 : 1;
        CHECK(polygons(box).size() == 6 + 2 * 12 * 4 + 8 * 16);
        CHECK(is_closed(polygons(box)));
        CHECK(enclosed_volume(polygons(box)) * sign > 0);
        std::size_t smoothed = 0;
        for (std::size_t i = 1; i < box.primitives.size(); ++i) {
            const PrimitiveText& triangle = box.primitives[i];
            if (triangle.modifier != "Phong") continue;
            ++smoothed;
            const PrimitiveText& texture = box.primitives[i - 1];
            REQUIRE(texture.name == "Phong");
            CHECK(texture.modifier == "wood");
            CHECK(texture.strings == std::vector<std::string>{"dx", "dy", "dz", "tmesh.cal"});
            const Vec3 flat = test::polygon_normal(triangle);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 p = vertex(triangle, k);
                const auto d = library.values(std::span(texture.strings).first(3), texture.reals,
                                              {.normal = flat, .position = p});
                // The nearest point of the box that is smaller by the radius lies straight below.
                const Vec3 core{std::clamp(p.x, .5, 2.5), std::clamp(p.y, .5, 3.5),
                                std::clamp(p.z, .5, 4.5)};
                CHECK(near(flat + Vec3{d[0], d[1], d[2]}, normalize(p - core) * sign, 1e-6));
            }
        }
        CHECK(smoothed == 2 * 12 * 4 + 8 * 16);
    }
}

TEST_CASE("genbox -o: a Wavefront object") {
    test::Silence sink;
    const std::string text = test::generate_text("genbox wood crate 3 4 5 -o", {}, sink);
    std::istringstream lines(text);
    std::size_t vertices = 0;
    std::size_t faces = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("v ")) ++vertices;
        if (line.starts_with("f ")) ++faces;
    }
    CHECK(vertices == 24);
    CHECK(faces == 6);
    CHECK(text.find("usemtl wood\no crate\nv 3 0 0\n") != std::string::npos);
    CHECK(text.find("\nf -24 -23 -22 -21\n") != std::string::npos);
    CHECK(test::generate_text("genbox w c 3 4 5 -r .5 -n 4 -s -o", {}, sink).find("\nvn ") !=
          std::string::npos);
}

TEST_CASE("genbox: mistakes are told with the usage") {
    const std::string usage = "; usage: genbox material name xsize ysize zsize ";
    CHECK(generator_error("genbox m b 1 2").starts_with("genbox: missing z size" + usage));
    CHECK(generator_error("genbox m b 1 0 2")
              .starts_with("genbox: bad y size \"0\", expected more than 0" + usage));
    CHECK(generator_error("genbox m b 1 2,5 2")
              .starts_with("genbox: bad y size \"2,5\", expected a number" + usage));
    CHECK(generator_error("genbox m b 1 1 1 -r 0").starts_with("genbox: bad radius \"0\""));
    CHECK(generator_error("genbox m b 1 1 1 -b -1").starts_with("genbox: bad bevel \"-1\""));
    CHECK(generator_error("genbox m b 1 1 1 -r .1 -n 0").find("number of segments \"0\"") !=
          std::string::npos);
    CHECK(generator_error("genbox m b 1 1 1 -r .1 -n 100000000").find("number of segments") !=
          std::string::npos);
    CHECK(generator_error("genbox m b 1 1 1 -x")
              .starts_with("genbox: unknown option \"-x\"" + usage));
}

}  // namespace lightwalk
