#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/model/transform_args.h"
#include "tests/io/generators/generated.h"
#include "tests/temporary_folder.h"

namespace lightwalk {
namespace {

using test::generate;
using test::generator_error;
using test::near;

std::string marker(const std::string& name, const std::vector<Vec3>& vertices) {
    std::string text = "mark polygon " + name + "\n0\n0\n" + std::to_string(3 * vertices.size());
    for (const Vec3& v : vertices) {
        text += "\n" + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z);
    }
    return text + "\n";
}

/// Legs of length 3 along `x` and 2 toward `y`, from `origin`.
std::string triangle(const Vec3& origin, const Vec3& x, const Vec3& y) {
    return marker("here", {origin, origin + 3 * x, origin + 2 * y});
}

}  // namespace

TEST_CASE("replmarks: the transform takes the axes to the marker's legs") {
    struct Frame {
        Vec3 x, y;
    };
    for (const Frame& frame :
         {Frame{{1, 0, 0}, {0, 1, 0}}, Frame{{0, 1, 0}, {-1, 0, 0}}, Frame{{0, 0, 1}, {0, 1, 0}},
          Frame{{0, 0, -1}, {0.6, 0.8, 0}}, Frame{{0.6, 0, 0.8}, {-0.8, 0, 0.6}},
          Frame{{0, -1, 0}, {0, 0, -1}}, Frame{{0.36, 0.48, 0.8}, {-0.8, 0.6, 0}}}) {
        const Vec3 origin{1, -2, 4};
        const auto result = generate("replmarks -s 1 -m paint -i thing.oct mark",
                                     {"", triangle(origin, frame.x, frame.y)});
        REQUIRE(result.primitives.size() == 1);
        const PrimitiveText& instance = result.primitives[0];
        CHECK(instance.type_word == "instance");
        CHECK(instance.modifier == "paint");
        CHECK(instance.name == "here");
        CHECK(instance.strings[0] == "thing.oct");
        const auto words = std::span(instance.strings).subspan(1);
        const ParsedTransform parsed = parse_transform(words);
        CHECK(parsed.words == words.size());
        const auto& m = parsed.transform;
        CHECK(near(m.forward.point({0, 0, 0}), origin, 1e-5));
        CHECK(near(m.forward.point({1, 0, 0}), origin + 3 * frame.x, 1e-5));
        CHECK(near(m.forward.point({0, 1, 0}), origin + 3 * frame.y, 1e-5));
    }
}

TEST_CASE("replmarks: words have six decimals, turns by nothing are left out") {
    const auto result =
        generate("replmarks -I thing.msh mark", {"", triangle({1, 2, 3}, {0, 1, 0}, {-1, 0, 0})});
    REQUIRE(result.primitives.size() == 1);
    CHECK(result.primitives[0].modifier == "void");
    CHECK(result.primitives[0].type_word == "mesh");
    CHECK(result.primitives[0].strings == std::vector<std::string>{"thing.msh", "-rz", "90.000000",
                                                                   "-t", "1.000000", "2.000000",
                                                                   "3.000000"});
}

TEST_CASE("replmarks: groups, everything else is copied") {
    const std::string scene =
        "# note\nvoid plastic paint\n0\n0\n5 .123456789012345 .5 .5 0 0\n"
        "other polygon floor\n0\n0\n9 0 0 0 1 0 0 0 1 0\n"
        "void alias mark paint\nmark sphere ball\n0\n0\n4 0 0 0 1\n!genbox m b 1 1 1\n" +
        triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const auto result = generate("replmarks -s 2 -x a.rad mark -m red -x b.rad other", {"", scene});
    CHECK(result.text.starts_with("# replmarks -s 2 -x a.rad mark -m red -x b.rad other\n"));
    CHECK(result.text.find("# note\n") != std::string::npos);
    CHECK(result.commands ==
          std::vector<std::string>{
              "!xform -n floor -m red -s 2.000000 -t 0.000000 0.000000 0.000000 b.rad",
              "!genbox m b 1 1 1",
              "!xform -n here -s 6.000000 -t 0.000000 0.000000 0.000000 a.rad"});
    REQUIRE(result.primitives.size() == 3);
    CHECK(result.primitives[0].reals[0] == 0.123456789012345);
    CHECK(result.primitives[1].type_word == "alias");
    CHECK(result.primitives[2].type_word == "sphere");
}

TEST_CASE("replmarks: -e runs commands, and looks for markers in the input's only") {
    const test::TemporaryFolder folder;
    folder.write("object.rad", triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    folder.write("scene.rad", "!genprism mark flat 3 0 0 3 0 0 2 -l 0 0 1 -c -c\n");
    const auto expanded =
        generate("replmarks -e -x object.rad mark scene.rad", {folder.path(), ""});
    CHECK(expanded.commands.empty());
    // both ends are triangles; the sides have two equal legs, and become markers, too
    REQUIRE(expanded.primitives.size() == 5);
    for (const PrimitiveText& primitive : expanded.primitives) {
        CHECK(primitive.modifier == "mark");
        CHECK(primitive.name.starts_with("flat."));
        CHECK(primitive.name.ends_with(".here"));
    }
    const auto kept = generate("replmarks -x object.rad mark scene.rad", {folder.path(), ""});
    CHECK(kept.commands ==
          std::vector<std::string>{"!genprism mark flat 3 0 0 3 0 0 2 -l 0 0 1 -c -c"});
}

TEST_CASE("replmarks: mistakes") {
    CHECK(generator_error("replmarks").find("usage: replmarks") != std::string::npos);
    CHECK(generator_error("replmarks -s 1 mark") != "");
    CHECK(generator_error("replmarks -x a.rad").find("usage: replmarks") != std::string::npos);
    CHECK(generator_error("replmarks -q -x a.rad mark").find("unknown option \"-q\"") !=
          std::string::npos);
    CHECK(generator_error("replmarks -x a.rad mark no_such_file").find("no_such_file") !=
          std::string::npos);
    std::string many = "replmarks";
    for (int i = 0; i < 129; ++i) many += " -x a.rad m" + std::to_string(i);
    CHECK(generator_error(many).find("128") != std::string::npos);
    const std::string line = marker("here", {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}});
    CHECK(generator_error("replmarks -x a.rad mark", {"", "\n" + line})
              .find("standard input:2: bad arguments for marker \"here\"") != std::string::npos);
    const std::string apart =
        marker("here", {{0, 0, 0}, {5, 0, 0}, {5, 1, 0}, {1, 1.5, 0}, {0, 1, 0}});
    CHECK(generator_error("replmarks -x a.rad mark", {"", apart}) == "");
    const std::string parallel = marker("here", {{0, 0, 0}, {5, 0, 0}, {5, 1, 0}, {1, 1, 0}});
    CHECK(generator_error("replmarks -x a.rad mark", {"", parallel}) == "");
}

}  // namespace lightwalk
