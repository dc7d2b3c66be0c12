// lightwalk render --light-group and lightwalk relight, from outside.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "io/picture/layers.h"
#include "tests/apps/program.h"
#include "tests/one_thread.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

std::string lit_room(double lamp, double bulb, double sky) {
    const auto three = [](double v) {
        const std::string text = std::to_string(v) + ' ';
        return text + text + text;
    };
    return "void light lamp 0 0 3 " + three(20 * lamp) + "void light bulb 0 0 3 " +
           three(40 * bulb) + "void glow heaven 0 0 4 " + three(sky) + R"(0
void plastic floor 0 0 5 .5 .4 .3 .1 .1
heaven source above 0 0 4 0 0 1 180
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
floor sphere ball 0 0 4 0 0 1 1
bulb sphere b 0 0 4 2 0 2 .1
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";
}

const std::vector<std::string> kView{"-vp", "0",  "-6", "2",   "-vd", "0",   "1",  "-.2", "-x",
                                     "48",  "-y", "32", "-vh", "45",  "-vv", "31", "-dt", "0"};

ProgramResult render(const std::vector<std::string>& words) {
    std::vector<std::string> all{"render"};
    all.insert(all.end(), kView.begin(), kView.end());
    all.insert(all.end(), words.begin(), words.end());
    return run_program(all);
}

void render_well(const std::vector<std::string>& words) {
    const ProgramResult result = render(words);
    CHECK(result.err.empty());
    REQUIRE(result.status == 0);
}

void relight_well(std::vector<std::string> words) {
    words.insert(words.begin(), "relight");
    const ProgramResult result = run_program(words);
    CHECK(result.err.empty());
    REQUIRE(result.status == 0);
}

std::vector<Rgb> pixels_of(const std::string& path) {
    const std::string bytes = read_whole(path);
    const LayersHeader header = read_layers_header(bytes, path);
    Picture sum{header.width, header.height, {}};
    sum.pixels.resize(static_cast<std::size_t>(header.width) *
                      static_cast<std::size_t>(header.height));
    add_layers(bytes, path, std::vector<Rgb>(header.names.size(), {1, 1, 1}), sum);
    return sum.pixels;
}

/// Largest difference in shares of `expected`, below a thousandth of its mean of that.
double largest_difference(const std::string& found, const std::string& expected) {
    const std::vector<Rgb> a = pixels_of(found), b = pixels_of(expected);
    REQUIRE(a.size() == b.size());
    double mean = 0, largest = 0;
    for (const Rgb& pixel : b)
        mean += static_cast<double>(brightness(pixel)) / static_cast<double>(b.size());
    REQUIRE(mean > 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto x = static_cast<double>(a[i][k]), y = static_cast<double>(b[i][k]);
            largest = std::max(largest, std::abs(x - y) / std::max(y, 1e-3 * mean));
        }
    }
    return largest;
}

/// A word of a command line that is wrong; `why` is said, and no file is made.
void check_refused(const ProgramResult& result, int status, const std::string& why) {
    CAPTURE(result.err);
    CHECK(result.status == status);
    CHECK(result.err.find(why) != std::string::npos);
    CHECK(result.out.empty());
}

}  // namespace

TEST_CASE("relight: layers of a picture add up to it, dimmed to that of the dimmed lights") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1)),
                      dimmed = folder.write("dimmed.rad", lit_room(.25, 0, 3));
    const auto file = [&](const char* name) { return folder.path(name); };
    render_well({"--light-group", "auto", "-o", file("all.exr"), scene});
    render_well({"--light-group", "auto", "-o", file("one_%s.exr"), scene});
    render_well({"-ps", "1", "-o", file("plain.exr"), scene});
    render_well({"-ps", "1", "-o", file("dimmed.exr"), dimmed});
    relight_well({"-o", file("sum.exr"), file("all.exr")});
    CHECK(largest_difference(file("sum.exr"), file("plain.exr")) < 1e-6);
    const std::vector<std::string> levels{"--group", "lamp=.25", "--group",
                                          "bulb=0",  "--group",  "sky=3"};
    std::vector<std::string> words{"-o", file("mixed.exr"), file("one_lamp.exr"),
                                   file("one_bulb.exr"), file("one_sky.exr")};
    words.insert(words.end(), levels.begin(), levels.end());
    relight_well(words);
    CHECK(largest_difference(file("mixed.exr"), file("dimmed.exr")) < 1e-6);
    words = levels;
    words.insert(words.end(), {"-o", file("mixed_2.exr"), file("all.exr")});
    relight_well(words);
    CHECK(largest_difference(file("mixed_2.exr"), file("dimmed.exr")) < 1e-6);
}

TEST_CASE("relight: Radiance pictures in and out, with the first one's view, on standard output") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1));
    render_well({"--light-group", "lamps=lamp,bul?", "-o", folder.path("f_%s.hdr"), scene});
    CHECK(folder.files() == std::vector<std::string>{"f_lamps.hdr", "f_rest.hdr", "room.rad"});
    render_well({"-ps", "1", "-o", folder.path("plain.exr"), scene});
    const ProgramResult result =
        run_program({"relight", folder.path("f_lamps.hdr"), folder.path("f_rest.hdr")});
    REQUIRE(result.status == 0);
    const std::string sum = folder.write("sum.hdr", result.out);
    // Three times rounded to steps of 1/256 of the largest channel, here up to twice the others.
    CHECK(largest_difference(sum, folder.path("plain.exr")) < 3. / 128);
    CHECK(result.out.find("VIEW= -vtv -vp 0 -6 2") != std::string::npos);
    CHECK(result.out.find("LIGHT_GROUP") == std::string::npos);
    CHECK(result.out.find("\nlightwalk relight\n") != std::string::npos);
}

TEST_CASE("relight: a level may be a colour") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1));
    render_well({"--light-group", "bulb=bulb", "-o", folder.path("all.exr"), scene});
    relight_well({folder.path("all.exr"), "--group", "rest=0", "--group", "bulb=2,1,.5,0", "-o",
                  folder.path("warm.exr")});
    relight_well({folder.path("all.exr"), "--group", "rest=0", "-o", folder.path("white.exr")});
    const std::vector<Rgb> warm = pixels_of(folder.path("warm.exr")),
                           white = pixels_of(folder.path("white.exr"));
    CHECK(std::ranges::any_of(white, [](const Rgb& p) { return p.b > 0; }));
    for (std::size_t i = 0; i < warm.size(); ++i) CHECK(warm[i] == white[i] * Rgb{2, 1, 0});
}

TEST_CASE("render --light-group on ranks: the layers of one process") {
    if (!mpirun(1)) {
        MESSAGE("skipped: no mpirun here");
        return;
    }
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1));
    std::vector<std::string> options{"--light-group", "auto"};
    bool same = true;
    SUBCASE("direct light") {}
    SUBCASE("indirect light in rounds") {
        options.insert(options.end(), {"-ab", "1", "-ad", "64", "--deterministic"});
    }
    SUBCASE("indirect light that ranks exchange") {
        options.insert(options.end(), {"-ab", "1", "-ad", "64", "--ambient-batch", "1"});
        same = false;
    }
    const auto draw = [&](const std::string& name, const std::vector<std::string>& more,
                          const std::vector<std::string>& launcher) {
        std::vector<std::string> words{"render"};
        for (const auto& some : {kView, options, more})
            words.insert(words.end(), some.begin(), some.end());
        words.insert(words.end(), {"-o", folder.path(name), scene});
        const ProgramResult result = run_program(words, "", launcher);
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
    };
    draw("one_%s.exr", {"-n", "2"}, {});
    draw("ranks_%s.exr", {"--variant", "ranks"}, *mpirun(3));
    draw("hybrid_%s.exr", {"-n", "2"}, *mpirun(2));
    for (const char* layer : {"lamp", "bulb", "sky"}) {
        CAPTURE(layer);
        for (const char* who : {"ranks_", "hybrid_"}) {
            const std::vector<Rgb> found =
                                       pixels_of(folder.path(std::string(who) + layer + ".exr")),
                                   one =
                                       pixels_of(folder.path(std::string("one_") + layer + ".exr"));
            if (same) {
                CHECK(found == one);
                continue;
            }
            Rgb sum, wanted;
            for (const Rgb& pixel : found) sum += pixel;
            for (const Rgb& pixel : one) wanted += pixel;
            CHECK(max_component(wanted) > 0);
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(std::abs(sum[k] - wanted[k]) < .1F * wanted[k]);
        }
    }
}

TEST_CASE("render --light-group: what cannot be done is said, and nothing written") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1)),
                      exr = folder.path("a.exr");
    const auto refused = [&](std::vector<std::string> words, int status, const std::string& why) {
        words.push_back(scene);
        check_refused(render(words), status, why);
    };
    refused({"--light-group", "auto"}, 2, "name the layers' files with -o");
    refused({"--light-group", "auto", "-o", folder.path("a.hdr")}, 2,
            "expected FILE.exr, or with %s");
    refused({"--light-group", "auto", "-o", folder.path("%s.png")}, 2, "layers of radiance");
    refused({"--light-group", "auto", "-o", folder.path("%s_%s.hdr")}, 2, "more than one %s");
    refused({"--light-group", "lamps", "-o", exr}, 2, "expected auto or NAME=PATTERN");
    refused({"--light-group", "=lamp", "-o", exr}, 2, "needs a name");
    refused({"--light-group", "a=", "-o", exr}, 2, "needs a name and a pattern");
    refused({"--light-group", "a=lamp", "--light-group", "a=bulb", "-o", exr}, 2, "twice");
    refused({"--light-group", "a=lamp", "--light-group", "auto", "-o", exr}, 2,
            "auto goes with no other");
    refused({"--light-group", "a=candle", "-o", exr}, 1,
            "\"a\": nothing that emits light has such a modifier; there is bulb heaven lamp");
    refused({"--light-group", "auto", "-o", exr, "-ab", "1", "-af", folder.path("x.amb")}, 2,
            "an ambient file holds no values of light groups");
    refused({"--light-group", "auto", "-o", exr, "--checkpoint", folder.path("c")}, 2,
            "not kept in checkpoints");
    CHECK(folder.files() == std::vector<std::string>{"room.rad"});
    const ProgramResult animate =
        run_program({"animate", "--light-group", "auto", "-o", "f%d.hdr", scene});
    CHECK(animate.status == 2);
}

TEST_CASE("relight: what cannot be done is said, and what was there stays") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", lit_room(1, 1, 1));
    render_well({"--light-group", "auto", "-o", folder.path("all.exr"), scene});
    render_well({"--light-group", "auto", "-o", folder.path("f_%s.hdr"), scene});
    render_well(
        {"--light-group", "auto", "-x", "20", "-y", "20", "-o", folder.path("s_%s.hdr"), scene});
    const std::string out = folder.write("out.hdr", "as it was");
    const std::string lamp = folder.path("f_lamp.hdr");
    const auto refused = [&](std::vector<std::string> words, int status, const std::string& why) {
        words.insert(words.begin(), {"relight", "-o", out});
        check_refused(run_program(words), status, why);
        CHECK(read_whole(out) == "as it was");
    };
    refused({}, 2, "name the layers' files");
    refused({"-"}, 2, "standard input is none");
    refused({folder.path("none.hdr")}, 1, "none.hdr");
    refused({lamp, "--group", "sun=1"}, 1, "no layer has light group \"sun\": there is lamp");
    refused({lamp, "--group", "lamp"}, 2, "expected NAME=LEVEL");
    for (const char* wrong : {"lamp=-1", "lamp=x", "lamp=1,2", "lamp=1,1,1,nan", "lamp=inf", "=1",
                              "lamp=", "lamp=1,1,1,1,1"})
        refused({lamp, "--group", wrong}, 2, "expected NAME=LEVEL or NAME=LEVEL,R,G,B");
    refused({lamp, "--group", "lamp=1", "--group", "lamp=2"}, 2, "two levels of \"lamp\"");
    refused({lamp, folder.path("s_sky.hdr")}, 1, "s_sky.hdr: is 20 by ");
    refused({lamp, lamp}, 1, "light group \"lamp\" is in ");
    refused({lamp, folder.path("all.exr")}, 1, "light group \"lamp\" is in ");
    refused({lamp, scene}, 1, "room.rad");
    const std::string bytes = read_whole(folder.path("all.exr"));
    const std::string part = folder.write("part.exr", bytes.substr(0, bytes.size() - 900));
    refused({part}, 1, "part.exr: damaged OpenEXR file");
    CHECK(run_program({"relight", "-o", folder.path("a.tif"), lamp}).status == 1);
}

namespace {

/// Scenes that are files in a folder, with lights as they are and dimmed.
struct DimmedScene {
    std::string folder;
    std::vector<std::string> words;   ///< the view, and files beside the lights
    std::string lights, dimmed;       ///< files
    std::vector<std::string> groups;  ///< NAME=PATTERN
    std::vector<std::string> levels;  ///< NAME=LEVEL, which make the one of the other
};

void check_dimmed(const DimmedScene& scene, const std::vector<std::string>& options) {
    const TemporaryFolder files;
    const auto draw = [&](const std::vector<std::string>& more, const std::string& lights,
                          const std::string& name) {
        std::vector<std::string> words{"render", "-w", "-x", "20", "-y", "15", "-dt", "0"};
        for (const auto& some : {options, more, {"-o", files.path(name)}, scene.words, {lights}})
            words.insert(words.end(), some.begin(), some.end());
        const ProgramResult result =
            run_program(words, "", {"env", "-C", scene.folder, "RAYPATH=.:../lib"});
        CAPTURE(result.err);
        REQUIRE(result.status == 0);
    };
    std::vector<std::string> groups, levels{files.path("all.exr"), "-o", files.path("mixed.exr")};
    for (const std::string& group : scene.groups)
        groups.insert(groups.end(), {"--light-group", group});
    for (const std::string& level : scene.levels) levels.insert(levels.end(), {"--group", level});
    draw(groups, scene.lights, "all.exr");
    draw({"-ps", "1"}, scene.lights, "plain.exr");
    draw({"-ps", "1"}, scene.dimmed, "dimmed.exr");
    relight_well({files.path("all.exr"), "-o", files.path("sum.exr")});
    relight_well(levels);
    CHECK(largest_difference(files.path("sum.exr"), files.path("plain.exr")) < 1e-5);
    CHECK(largest_difference(files.path("mixed.exr"), files.path("dimmed.exr")) < 1e-5);
    CHECK(largest_difference(files.path("plain.exr"), files.path("dimmed.exr")) > .1);
}

const std::vector<std::string> kDimmedIndirect{
    "--ambient-lights", "0", "-ab", "1", "-aa", "0", "-ad", "16", "-as", "0", "-av", "0", "0", "0"};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Rows of ceiling lamps over desks.
std::string lamp_office(double window_side, double hall_side) {
    const auto emission = [](double level) {
        std::string text;
        for (const double channel : {18., 17., 15.}) text += std::to_string(level * channel) + ' ';
        return text + '\n';
    };
    std::string text =
        "void plastic white 0 0 5 .75 .75 .75 0 0\nvoid plastic wood 0 0 5 .45 .3 .18 .03 .08\n"
        "void metal steel 0 0 5 .6 .6 .62 .8 .1\nvoid brightfunc spread 2 max(-Dz,Dz)^2 . 0 0\n"
        "spread light window_lamp 0 0 3 " +
        emission(window_side) + "spread light hall_lamp 0 0 3 " + emission(hall_side) +
        "white polygon floor 0 0 12 0 0 0 12 0 0 12 9 0 0 9 0\n"
        "white polygon ceiling 0 0 12 0 0 3 0 9 3 12 9 3 12 0 3\n"
        "white polygon north 0 0 12 0 9 0 0 9 3 12 9 3 12 9 0\n"
        "white polygon east 0 0 12 12 0 0 12 0 3 12 9 3 12 9 0\n";
    for (int i = 0; i < 36; ++i) {
        const int column = i % 6, row = i / 6;
        const auto n = [](double value) { return ' ' + std::to_string(value); };
        const double x = 1 + 2 * column, y = .75 + 1.5 * row;
        const std::string number = std::to_string(i);
        text += std::string(row < 3 ? "hall" : "window") + "_lamp polygon lamp" + number +
                " 0 0 12" + n(x - .5) + n(y - .1) + " 2.98" + n(x - .5) + n(y + .1) + " 2.98" +
                n(x + .5) + n(y + .1) + " 2.98" + n(x + .5) + n(y - .1) + " 2.98\n" +
                "wood ring desk" + number + " 0 0 8" + n(x) + n(y) + " .7 0 0 1 0 .6\n" +
                "steel cylinder leg" + number + " 0 0 7" + n(x) + n(y) + " 0" + n(x) + n(y) +
                " .7 .05\n";
    }
    return text;
}

}  // namespace

TEST_CASE("relight: rooms of lamps of the reference, dimmed") {
    LIGHTWALK_NEEDS_SHARED(folder, "scenes/cabin");
    const TemporaryFolder files;
    const std::string dim =
        files.write("lights", replaced(read_whole(folder + "/lights"), "3\t10 10 10", "3\t4 4 4"));
    check_dimmed({folder,
                  {"-vf", "vf/living", "pattmats", "cabin", "bathroom", "furniture", "winpanes.rad",
                   "mirrors.rad", "summerday"},
                  "lights",
                  dim,
                  {"globes=big_globe_light"},
                  {"globes=.4"}},
                 kDimmedIndirect);
}

TEST_CASE("relight: the demo scene of an evening and an office of lamps, dimmed" * about_numbers) {
    const TemporaryFolder files;
    DimmedScene scene;
    SUBCASE("demo scene") {
        scene.folder = LIGHTWALK_SOURCE "/apps/scenes/lodge";
        scene.words = {"-vf", "views/living.vf", "lodge.rad"};
        scene.lights = "night.rad";
        std::string dim = read_whole(scene.folder + "/night.rad");
        dim = replaced(dim, "3 44 37 28", "3 11 9.25 7");
        dim = replaced(dim, "3 62 27 8", "3 124 54 16");
        scene.dimmed = files.write("dim.rad", dim);
        scene.groups = {"lamps=warm", "fire=fire_light"};
        scene.levels = {"lamps=.25", "fire=2"};
    }
    SUBCASE("office of lamps") {
        scene.folder = files.path("");
        // In these pixels a dimmed lamp is as bright as the ceiling beside it, and covers 1 % of
        // one.
        scene.words = {"-vp", ".5", ".5",  "1.7", "-vd", "12", "9",  "-4",
                       "-vh", "70", "-vv", "55",  "-x",  "16", "-y", "12"};
        scene.lights = files.write("lit.rad", lamp_office(1, 1));
        scene.dimmed = files.write("dim.rad", lamp_office(.1, .7));
        scene.groups = {"window=window_*", "hall=hall_*"};
        scene.levels = {"window=.1", "hall=.7"};
    }
    CAPTURE(scene.folder);
    check_dimmed(scene, {});
    check_dimmed(scene, kDimmedIndirect);
}
