// Scene files behind an octree or a frozen scene: a kept building gets another sky.
#include <doctest/doctest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "core/model/primitive.h"
#include "io/scene/scene_reader.h"
#include "tests/apps/program.h"
#include "tests/io/scene/octree_bytes.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kBuilding = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void brightfunc stripes 2 stain dirt.cal 0 0
stripes plastic wood 0 0 5 .5 .25 .25 0 0
void light lamp 0 0 3 10 10 10
white polygon floor 0 0 12 0 0 0 4 0 0 4 4 0 0 4 0
wood sphere ball 0 0 4 3 3 .5 .5
lamp polygon l 0 0 12 1 1 3 1 3 3 3 3 3 3 1 3
)";
const std::string kSun = R"(
void light sun 0 0 3 1e5 1e5 1e5
sun source s 0 0 4 0 0 1 .5
void brightfunc cloudy 2 cloud cloud.cal 0 0
cloudy glow sky 0 0 4 .5 .5 1 0
sky source dome 0 0 4 0 0 1 180
void plastic white 0 0 5 .25 .5 .25 0 0
white sphere tree 0 0 4 1 3 .5 .5
wood sphere bench 0 0 4 1 1 .5 .5
)";

struct KeptBuilding {
    KeptBuilding() {
        folder.write("room.rad", kBuilding);
        folder.write("sun.rad", kSun);
        folder.write("dirt.cal", "stain = .5 + .5*sin(4*Px);\n");
        folder.write("cloud.cal", "cloud = .5 + .5*Dz;\n");
        Silence silence;
        const auto model =
            read_scene(std::vector<std::string>{"room.rad"},
                       {LibraryPath({"."}), false, folder.path(), {}, nullptr}, silence);
        folder.write("frozen.oct", frozen_octree(*model));
        folder.write("referring.oct", referring_octree({"room.rad"}, model->size()));
        REQUIRE(run({"freeze", "room.rad", "-o", "room.lwz"}).status == 0);
    }
    [[nodiscard]] ProgramResult run(const std::vector<std::string>& words,
                                    const std::string& input = "",
                                    std::vector<std::string> launcher = {}) const {
        launcher.insert(launcher.end(), {"env", "--chdir=" + folder.path()});
        return run_program(words, input, launcher);
    }
    [[nodiscard]] std::string trace(std::vector<std::string> scene,
                                    const std::vector<std::string>& launcher = {}) const {
        std::vector<std::string> words{"trace", "-h", "-ovsm", "-av", ".1", ".1", ".1"};
        words.insert(words.end(), scene.begin(), scene.end());
        const ProgramResult result = run(
            words,
            "2 2 2 0 0 -1\n2.9 2.8 2 0 0 -1\n1.1 2.9 2 0 0 -1\n1.1 1.2 2 0 0 -1\n2 2 2 .1 1 .3\n",
            launcher);
        CHECK(result.err == "");
        CHECK(result.status == 0);
        return result.out;
    }
    TemporaryFolder folder;
};

/// Words are equal; numbers are so up to the mantissa of an octree and the digits printed.
void check_alike(const std::string& got, const std::string& expected) {
    std::istringstream a(got), b(expected);
    for (std::string x, y; b >> y;) {
        a >> x;
        REQUIRE_FALSE(a.fail());
        char* end = nullptr;
        const double number = std::strtod(y.c_str(), &end);
        if (*end == '\0')
            CHECK(std::stod(x) == within(2e-6, number) /* seven digits, and shading */);
        else
            CHECK(x == y);
    }
}

}  // namespace

TEST_CASE("files behind an octree or a frozen scene add to it, in every command") {
    const KeptBuilding kept;
    const std::string expected = kept.trace({"room.rad", "sun.rad"});
    REQUIRE(expected.find("tree") != std::string::npos);
    CHECK(kept.trace({"referring.oct", "sun.rad"}) == expected);
    CHECK(kept.trace({"room.lwz", "sun.rad"}) == expected);
    check_alike(kept.trace({"frozen.oct", "sun.rad"}), expected);

    const auto picture = [&](const std::vector<std::string>& scene) {
        std::vector<std::string> words{"render", "-vp", "2",  "1",  "1",  "-vd", "0",    "1",
                                       "-.5",    "-x",  "40", "-y", "30", "-o",  "p.hdr"};
        words.insert(words.end(), scene.begin(), scene.end());
        const ProgramResult result = kept.run(words);
        CHECK(result.err == "");
        const std::string bytes = read_whole(kept.folder.path("p.hdr"));
        return bytes.substr(std::min(bytes.find("\n\n"), bytes.size()));
    };
    const std::string pixels = picture({"room.rad", "sun.rad"});
    REQUIRE(pixels.size() > 1000);
    CHECK(picture({"room.lwz", "sun.rad"}) == pixels);

    const auto facts = [&](const std::vector<std::string>& scene) {
        std::vector<std::string> words{"info"};
        words.insert(words.end(), scene.begin(), scene.end());
        const std::string out = kept.run(words).out;
        const std::size_t begin = out.find("primitives"), end = out.find("bounds");
        return out.substr(begin, end - begin);
    };
    CHECK(facts({"room.lwz", "sun.rad"}) == facts({"room.rad", "sun.rad"}));
    CHECK(facts({"room.lwz", "sun.rad"}).find("source       2") != std::string::npos);
}

TEST_CASE("a frozen scene with files is frozen again, and knows the files of both") {
    const KeptBuilding kept;
    const std::string expected = kept.trace({"room.rad", "sun.rad"});
    for (const char* base : {"room.lwz", "referring.oct"}) {
        REQUIRE(kept.run({"freeze", base, "sun.rad", "-o", "both.lwz"}).status == 0);
        CHECK(kept.trace({"both.lwz"}) == expected);
        for (const auto& [file, text] : {std::pair{"sun.rad", kSun}, {"room.rad", kBuilding}}) {
            kept.folder.write(file, text + "# changed\n");
            const ProgramResult stale = kept.run({"trace", "both.lwz"});
            CHECK(stale.status == 1);
            CHECK(stale.err.find(std::string(file) + " has changed") != std::string::npos);
            kept.folder.write(file, text);
        }
    }
}

TEST_CASE("ranks add files to a frozen scene as one process does") {
    if (!mpirun(1)) {
        MESSAGE("skipped: no mpirun here");
        return;
    }
    const KeptBuilding kept;
    const std::string expected = kept.trace({"room.rad", "sun.rad"});
    for (const char* from : {"shared", "each", "rank0"})
        CHECK(kept.trace({"--scene-from", from, "room.lwz", "sun.rad"}, *mpirun(2)) == expected);
}

TEST_CASE("an octree or frozen scene that is not the first file is refused by name") {
    const KeptBuilding kept;
    for (const char* late : {"frozen.oct", "room.lwz"}) {
        for (const char* first : {"sun.rad", "frozen.oct", "room.lwz"}) {
            const ProgramResult result = kept.run({"trace", first, late}, "2 2 2 0 0 -1\n");
            CHECK(result.status == 1);
            CHECK(result.out.empty());
            const std::string complaint = std::string(late) + ": " + kOneBase + '\n';
            CHECK(result.err.find(complaint) != std::string::npos);
        }
    }
}
