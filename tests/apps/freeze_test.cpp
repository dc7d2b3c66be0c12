// lightwalk freeze, and every command with what it writes.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/io/gltf/small_gltf.h"
#include "tests/io/picture/small_images.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void brightfunc dirt 2 stain dirt.cal 0 0
dirt plastic floor 0 0 5 .5 .4 .3 .1 .1
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
!genbox floor crate 1 1 1
floor sphere ball 0 0 4 0 0 3 1
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

/// room.rad and what it needs, in a folder that programs are run in.
struct FrozenRoom {
    FrozenRoom() {
        folder.write("room.rad", kRoom);
        folder.write("dirt.cal", "stain = .5 + .5*sin(4*Px);\n");
    }
    [[nodiscard]] ProgramResult run(const std::vector<std::string>& words,
                                    const std::string& input = "") const {
        return run_program(words, input, {"env", "--chdir=" + folder.path()});
    }
    [[nodiscard]] ProgramResult freeze() const {
        return run({"freeze", "room.rad", "-o", "room.lwz"});
    }
    TemporaryFolder folder;
};

std::vector<std::string> render(const std::string& scene) {
    return {"render", "-vp", "0",  "-6", "2",   "-vd", "0",   "1",  "-.2",
            "-x",     "60",  "-y", "40", "-ab", "1",   "-ad", "32", "--deterministic",
            "-w-",    "-o",  "-",  scene};
}

std::string pixels_of(const std::string& picture) {
    const std::size_t begin = picture.find("\n\n");
    return begin == std::string::npos ? std::string() : picture.substr(begin);
}

}  // namespace

TEST_CASE("freeze: commands make the same bytes of the frozen scene as of its files") {
    const FrozenRoom room;
    const ProgramResult frozen = room.freeze();
    CHECK(frozen.err.empty());
    REQUIRE(frozen.status == 0);
    CHECK(frozen.out.empty());
    const auto render_to = [&](const std::string& scene) {
        std::vector<std::string> words = render(scene);
        words[words.size() - 2] = "picture.hdr";
        const ProgramResult result = room.run(words);
        CHECK(result.err.empty());
        CHECK(result.status == 0);
        return pixels_of(read_whole(room.folder.path("picture.hdr")));
    };
    const std::string expected = render_to("room.rad");
    REQUIRE(expected.size() > 1000);
    CHECK(render_to("room.lwz") == expected);

    const std::string rays = "0 0 9 0 0 -1\n0 -6 2 0 1 0\n.5 .5 3 0 0 -1\n";
    const auto trace = [&](const std::string& scene) {
        return room.run({"trace", "-h", "-ovpsmN", "-w-", scene}, rays);
    };
    CHECK(trace("room.rad").out.size() > 100);
    CHECK(trace("room.lwz").out == trace("room.rad").out);

    const ProgramResult info = room.run({"info", "room.lwz"});
    CHECK(info.status == 0);
    CHECK(info.out.find("frozen         from 2 files") != std::string::npos);
    CHECK(info.out.find("surfaces       9, and 0 inside instances") != std::string::npos);
}

TEST_CASE("freeze: ranks map the file themselves, and draw the same bytes") {
    if (!mpirun(1)) {
        MESSAGE("skipped: no mpirun here");
        return;
    }
    const FrozenRoom room;
    REQUIRE(room.freeze().status == 0);
    const std::string scene = room.folder.path("room.lwz"), out = room.folder.path("a.hdr");
    const auto draw = [&](std::vector<std::string> words,
                          const std::vector<std::string>& launcher) {
        words[words.size() - 2] = out;
        std::filesystem::remove(out);
        const ProgramResult result = run_program(words, "", launcher);
        CHECK(result.status == 0);
        return pixels_of(read_whole(out));
    };
    const std::string expected = draw(render(scene), {});
    REQUIRE(expected.size() > 1000);
    for (const char* from : {"each", "rank0"}) {
        std::vector<std::string> words = render(scene);
        words.insert(words.begin() + 1, {"--variant", "ranks", "--scene-from", from});
        CHECK(draw(words, *mpirun(3)) == expected);
    }
}

TEST_CASE("freeze: a scene whose files have changed is named and refused, unless --stale") {
    const FrozenRoom room;
    REQUIRE(room.freeze().status == 0);
    room.folder.write("dirt.cal", "stain = 1;\n");
    const std::string ray = "0 0 9 0 0 -1\n";
    const ProgramResult stale = room.run({"trace", "-h", "room.lwz"}, ray);
    CHECK(stale.status == 1);
    CHECK(stale.out.empty());
    CHECK(stale.err == "room.lwz: stale: " + room.folder.path("dirt.cal") +
                           " has changed; freeze it again, or use --stale\n");
    const ProgramResult taken = room.run({"trace", "-h", "--stale", "room.lwz"}, ray);
    CHECK(taken.status == 0);
    CHECK(taken.out.size() > 5);
    REQUIRE(room.freeze().status == 0);
    CHECK(room.run({"trace", "-h", "room.lwz"}, ray).status == 0);
}

TEST_CASE("freeze: damaged files, and those that cannot be meant, are refused") {
    const FrozenRoom room;
    REQUIRE(room.freeze().status == 0);
    const std::string whole = read_whole(room.folder.path("room.lwz"));
    std::string damaged = whole;
    REQUIRE(damaged.find("stain = ") != std::string::npos);
    damaged[damaged.find("stain = ")] = 'S';
    room.folder.write("damaged.lwz", damaged);
    room.folder.write("short.lwz", whole.substr(0, whole.size() / 2));
    const auto refusal = [&](const std::vector<std::string>& words) {
        const ProgramResult result = room.run(words);
        CHECK(result.status != 0);
        return result.err;
    };
    CHECK(refusal({"info", "damaged.lwz"}).starts_with("damaged.lwz: damaged: part "));
    CHECK(refusal({"info", "short.lwz"}) == "short.lwz: truncated: its end is missing\n");
    CHECK(refusal({"freeze", "room.lwz", "-o", "b.lwz"}) == "room.lwz: is frozen already\n");
    CHECK(refusal({"freeze", "room.rad"}).find("with -o") != std::string::npos);
    CHECK(refusal({"freeze", "room.rad", "-o", "./room.rad"}).find("is a file of the scene") !=
          std::string::npos);
    CHECK(refusal({"freeze", "room.rad", "-o", "b.lwz", "--stael"}).find("did you mean --stale?") !=
          std::string::npos);
    room.folder.write("bad.rad", "void warpfield a 0 0 0\na sphere b 0 0 4 0 0 0 1\n");
    CHECK(refusal({"freeze", "bad.rad", "-o", "b.lwz"}).find("bad.rad:1") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(room.folder.path("b.lwz")));
}

TEST_CASE("freeze: a frozen glTF file holds its meshes and images, and an .obj its texture") {
    const TemporaryFolder folder;
    SmallGltf gltf;
    gltf.image = small_png();
    gltf.materials =
        R"({"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0},"alphaMode":"MASK"})";
    folder.write("x.glb", gltf.binary());
    folder.write(
        "y.obj",
        "mtllib y.mtl\nv 2 0 0\nv 3 0 0\nv 3 0 1\nvt 0 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/2\n");
    folder.write("y.mtl", "newmtl a\nmap_Kd t.png\n");
    folder.write("t.png", wide_png());
    const auto run = [&](const std::vector<std::string>& words) {
        return run_program(words, ".2 -1 .9 0 1 0\n.8 -1 .8 0 1 0\n2.8 -1 .2 0 1 0\n",
                           {"env", "--chdir=" + folder.path()});
    };
    const ProgramResult direct = run({"trace", "-h", "-av", "1", "1", "1", "x.glb", "y.obj"});
    REQUIRE(direct.status == 0);
    REQUIRE(run({"freeze", "x.glb", "y.obj", "-o", "x.lwz"}).status == 0);
    for (const char* file : {"x.glb", "y.obj", "y.mtl", "t.png"})
        std::filesystem::remove(folder.path(file));
    const ProgramResult frozen = run({"trace", "-h", "-av", "1", "1", "1", "--stale", "x.lwz"});
    CHECK(frozen.status == 0);
    CHECK(frozen.out == direct.out);
    CHECK(direct.out.find("0.000000e+00\t0.000000e+00\t0.000000e+00") == std::string::npos);
}
