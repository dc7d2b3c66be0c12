// Files that a scene names and that are not there.
#include <doctest/doctest.h>

#include <string>

#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

struct Case {
    std::string modifier;  ///< defines "paint"; its first line is line 1 of the scene
    std::string problem;
};

/// A modifier for each kind of file; "paint" is on the disc, which only rays downwards see.
const Case kCases[] = {
    {"void colorpict p 7 red green blue no.hdr . u v 0 0\np plastic paint 0 0 5 1 1 1 0 0\n",
     "colorpict \"p\": cannot find file \"no.hdr\""},
    {"void brightdata p 4 noop no.dat . u 0 0\np plastic paint 0 0 5 1 1 1 0 0\n",
     "brightdata \"p\": cannot find file \"no.dat\""},
    {"void brighttext p 2 no.fnt hello 0 11 0 0 0 1 0 0 0 1 0 1 0\np plastic paint 0 0 5 1 1 1 0 "
     "0\n",
     "brighttext \"p\": cannot find file \"no.fnt\""},
    {"void brightfunc p 2 v no.cal 0 0\np plastic paint 0 0 5 1 1 1 0 0\n",
     "brightfunc \"p\": cannot find file \"no.cal\""},
    {"void plasdata paint 4 noop no.dat . u 0 4 1 1 1 0\n",
     "plasdata \"paint\": cannot find file \"no.dat\""},
};
const std::string kDisc = "paint ring disc 0 0 8 0 0 0 0 0 1 0 1\n";
const std::string kLamp = "void glow lit 0 0 4 1 2 3 0\nlit sphere ball 0 0 4 0 0 9 1\n";

}  // namespace

TEST_CASE("missing file: a warning with file and line, and what does not show it can be traced") {
    for (const Case& missing : kCases) {
        CAPTURE(missing.problem);
        TestScene scene(missing.modifier + kDisc + kLamp);
        REQUIRE(scene.warnings.messages.size() == 1);
        CHECK(scene.warnings.messages[0] == "test.rad:1: " + missing.problem);
        CHECK(scene.trace({0, 0, 3}, {0, 0, 1}).value == Rgb{1, 2, 3});
    }
}

TEST_CASE("missing file: the first ray that needs it fails with the warning's words") {
    for (const Case& missing : kCases) {
        CAPTURE(missing.problem);
        TestScene scene(missing.modifier + kDisc + kLamp);
        CHECK_THROWS_WITH_AS((void)scene.trace({0.5, 0, 3}, {0, 0, -1}),
                             ("test.rad:1: " + missing.problem).c_str(), InputError);
    }
}

TEST_CASE("missing file: octrees and meshes stop the scene, since every ray may need them") {
    CHECK_THROWS_AS(TestScene("void instance i 1 no.oct 0 0\n"), InputError);
    CHECK_THROWS_AS(TestScene("void mesh m 1 no.rtm 0 0\n"), InputError);
}
