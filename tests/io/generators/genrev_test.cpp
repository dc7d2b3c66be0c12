#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/io/generators/generated.h"
#include "tests/io/generators/library_file.h"

namespace lightwalk {
namespace {

using test::generate;
using test::generator_error;
using test::near;

std::vector<std::string> types(const test::Generated& generated) {
    std::vector<std::string> result;
    for (const PrimitiveText& primitive : generated.primitives)
        result.push_back(primitive.type_word);
    return result;
}

}  // namespace

TEST_CASE("genrev: the piece follows from how height and radius change") {
    struct Piece {
        const char *z, *r, *type;
        std::vector<double> reals;
    };
    for (const Piece& piece : {Piece{"t", "2", "cylinder", {0, 0, 0, 0, 0, 1, 2}},
                               Piece{"1-t", "2", "tube", {0, 0, 1, 0, 0, 0, 2}},
                               Piece{"3", "2-t", "ring", {0, 0, 3, 0, 0, 1, 2, 1}},
                               Piece{"3", "1+t", "ring", {0, 0, 3, 0, 0, -1, 1, 2}},
                               Piece{"t", "1+t", "cone", {0, 0, 0, 0, 0, 1, 1, 2}},
                               Piece{"-t", "2-t", "cup", {0, 0, 0, 0, 0, -1, 2, 1}}}) {
        const auto result =
            generate(std::string("genrev m v '") + piece.z + "' '" + piece.r + "' 1");
        REQUIRE(result.primitives.size() == 1);
        CHECK(result.primitives[0].type_word == piece.type);
        CHECK(result.primitives[0].name == "v.1");
        CHECK(result.primitives[0].modifier == "m");
        CHECK(result.primitives[0].reals == piece.reals);
    }
}

TEST_CASE("genrev: pieces without extent are skipped, with their number") {
    const auto vase = generate("genrev m v 'z(3*t)' 1 3 -e 'z(x)=if(x-1.5,x-1,min(x,1))'");
    CHECK(types(vase) == std::vector<std::string>{"cylinder", "cylinder"});
    CHECK(test::names(vase) == std::vector<std::string>{"v.1", "v.3"});
}

TEST_CASE("genrev -s: rev.cal turns normals from the piece before to the piece after") {
    const auto bowl = generate("genrev m v '1-cos(PI/2*t)' 'sin(PI/2*t)' 6 -s");
    REQUIRE(bowl.primitives.size() == 12);
    const test::LibraryFile file = test::own_library_file("rev.cal");
    const std::vector<std::string> variables = {"rev_dx", "rev_dy", "rev_dz"};
    const auto profile = [](int i) {
        const double a = kPi / 2 * i / 6;
        return Vec3{std::sin(a), 0, 1 - std::cos(a)};
    };
    const auto segment_normal = [&](int i) {
        if (i < 1 || i > 6) return Vec3{};
        const Vec3 along = normalize(profile(i) - profile(i - 1));
        return Vec3{along.z, 0, -along.x};
    };
    for (int i = 1; i <= 6; ++i) {
        const PrimitiveText& texture = bowl.primitives[static_cast<std::size_t>(2 * i - 2)];
        const PrimitiveText& piece = bowl.primitives[static_cast<std::size_t>(2 * i - 1)];
        CHECK(texture.name == "Phong");
        CHECK(texture.strings == std::vector<std::string>{"rev_dx", "rev_dy", "rev_dz", "rev.cal"});
        CHECK(piece.modifier == "Phong");
        test::RayValues ray;
        for (const int end : {i - 1, i}) {
            if (end == 0) continue;  // on the axis there is no direction away from it
            const double angle = 0.7;
            const Vec3 p = profile(end);
            ray.position = {p.x * std::cos(angle), p.x * std::sin(angle), p.z};
            const auto d = file.values(variables, texture.reals, ray);
            const Vec3 n = segment_normal(end == i ? i + 1 : i - 1);
            CHECK(near({d[0], d[1], d[2]}, {n.x * std::cos(angle), n.x * std::sin(angle), n.z},
                       1e-8));
        }
    }
}

TEST_CASE("genrev: constant parts of the smoothing") {
    const auto cylinder = generate("genrev m v t 2 1 -s");
    CHECK(cylinder.primitives[0].reals == std::vector<double>{0, 0, 0, 1});
    const auto tube = generate("genrev m v -t 2 1 -s");
    CHECK(tube.primitives[0].reals[3] == -1);
    const auto ring = generate("genrev m v 1 2-t 1 -s");
    CHECK(ring.primitives[0].reals == std::vector<double>{0, 1, 0, 0});
}

TEST_CASE("genrev: mistakes") {
    CHECK(generator_error("genrev m v t 1").find("usage: genrev") != std::string::npos);
    CHECK(generator_error("genrev m v t 1 0").find("at least 1") != std::string::npos);
    CHECK(generator_error("genrev m v t 1 1e12").find("at most") != std::string::npos);
    CHECK(generator_error("genrev m v t nothing 2").find("nothing") != std::string::npos);
    CHECK(generator_error("genrev m v t 1 2 -q").find("unknown option") != std::string::npos);
    CHECK(generator_error("genrev m v t 1 2 -f no_such.cal").find("no_such.cal") !=
          std::string::npos);
}

}  // namespace lightwalk
