#include "io/wavefront/obj_mapping.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr const char* kMapped =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\no thing\ng grp sub\nusemtl red\n"
    "f 1 2 3 4\ng grp2\nf 1 2 5\nusemtl blue\nusemap tex\nf 2 3 5\ns 1\no other\ng\nf 3 4 5\n";

/// The materials of the four faces; "-": left out.
std::string mapped(const std::string& mapping) {
    const ObjFile file = decode_obj(kMapped, "x.obj");
    const auto rules = decode_obj_mapping(mapping, "x.map");
    std::string text;
    for (std::size_t i = 0; i < file.faces.size(); ++i)
        text += mapped_material(rules, file, file.faces[i], i + 1).value_or("-") + " ";
    return text;
}

std::string mapping_error(const std::string& mapping) {
    try {
        (void)mapped(mapping);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("obj mapping: faces have the materials that obj2rad -m gives them") {
    CHECK(mapped("default (Material \"red\");\nmetalred (Group \"grp2\");\n"
                 "woody (Object \"thing\") (Material \"blue\");\n") == "default metalred woody - ");
    CHECK(
        mapped("metal (Material \"red\");\nwood (Group \"grp\") (Face 1);\npaint (Map \"tex\");") ==
        "wood metal - - ");
    CHECK(mapped("all ;\npaint (Group \"sub\");\n") == "paint all all all ");
    CHECK(mapped("all;\nvoid (Face [2:3]);\n") == "all - - all ");
    CHECK(mapped("all ; b (Object \"other\");") == "all all all b ");
    CHECK(mapped("# com (Face 1);\nb (Face [ 1 : 2 ])\n;") == "b b - - ");
    CHECK(mapped("a # x\n;b (Face 1);") == "b a a a ");
    CHECK(mapped("b ( Face 1 )(Material \"red\")( Group \"grp\" ) ;") == "b - - - ");
    CHECK(mapped("b (Face -1);a (Face [-5:1]);") == "a - - - ");
    CHECK(mapped("a (Material \"RED\");") == "- - - - ");
    CHECK(mapped("all") == "all all all all ");
}

TEST_CASE("obj mapping: mistakes have their line") {
    CHECK(mapping_error("all;\nb (Foo \"x\");") ==
          "x.map:2: unknown qualifier \"Foo\", expected Material, Map, Group, Object or Face");
    CHECK(mapping_error("b (Group grp);") ==
          "x.map:1: found \"grp);\", expected \"text\", a number or [low:high]");
    CHECK(mapping_error("b (Face [3:2]);") ==
          "x.map:1: a range whose end comes before its beginning");
    CHECK(mapping_error("b (Face [1:]);").find("x.map:1: ") == 0);
    CHECK(mapping_error("b (Face 1) (Face 2);") ==
          "x.map:1: a second condition on Face in one rule");
    CHECK(mapping_error("b (Map \"\");").find("x.map:1: bad text") == 0);
    CHECK(mapping_error("b (Face 1").find("x.map:1: ") == 0);
    CHECK(mapping_error("(Face 1);").find("x.map:1: ") == 0);
    CHECK(mapping_error("b c;").find("x.map:1: ") == 0);
}

TEST_CASE("obj mapping: the qualifiers are what obj2rad -n lists") {
    CHECK(obj_qualifiers(decode_obj(kMapped, "m.obj"), "m.obj") ==
          "filename \"m.obj\"\nfiletype \"Wavefront\"\n"
          "qualifier Material begin\n\"blue\"\n\"red\"\nend\nqualifier Map begin\n\"tex\"\nend\n"
          "qualifier Group begin\n\"grp\"\n\"grp2\"\n\"sub\"\nend\n"
          "qualifier Object begin\n\"other\"\n\"thing\"\nend\n"
          "qualifier Face begin\n[1:4]\nend\n");
    CHECK(obj_qualifiers(decode_obj("v 0 0 0\n", "m.obj"), "<stdin>") ==
          "filename \"<stdin>\"\nfiletype \"Wavefront\"\nqualifier Face begin\n[1:0]\nend\n");
}

}  // namespace lightwalk
