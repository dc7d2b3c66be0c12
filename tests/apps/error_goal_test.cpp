// lightwalk render --error and --time, from outside.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/picture/layers.h"
#include "io/picture/picture.h"
#include "tests/apps/program.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A lamp behind bars: penumbrae on a floor.
const std::string kBars =
    "void plastic grey 0 0 5 .5 .4 .3 0 0\nvoid light lamp 0 0 3 20 20 20\n"
    "grey polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\n"
    "lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5\n"
    "grey polygon bar 0 0 12  -.6 -9 2  -.1 -9 2  -.1 9 2  -.6 9 2\n";

std::vector<std::string> render_words(std::vector<std::string> words, const std::string& scene) {
    words.insert(words.begin(), {"render", "-vp", "0", "-6", "1.5", "-x", "48", "-y", "32", "-pa",
                                 "0", "-dj", ".9", "-n", "1"});
    words.push_back(scene);
    return words;
}

std::string pixels_of(const std::string& picture) {
    return picture.substr(picture.find("\n\n"));
}

nlohmann::json sampling_of(const std::string& file) {
    return nlohmann::json::parse(read_whole(file)).at("sampling");
}

}  // namespace

TEST_CASE("render: --error is reached by more rays where it is smaller, and told") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars), stats = folder.path("s.json");
    double mean = 0;
    for (const double error : {.2, .05}) {
        CAPTURE(error);
        const ProgramResult made =
            run_program(render_words({"--error", std::to_string(error), "--stats", stats}, scene));
        REQUIRE(made.status == 0);
        CHECK(made.err.empty());
        const nlohmann::json sampling = sampling_of(stats);
        CHECK(sampling.at("error").get<double>() <= error);
        const nlohmann::json rays = sampling.at("rays_a_pixel");
        CHECK(rays.at("mean").get<double>() > 1.5 * mean);
        CHECK(rays.at("least").get<int>() >= 4);
        CHECK(rays.at("most").get<int>() >= rays.at("least").get<int>());
        mean = rays.at("mean").get<double>();
    }
}

TEST_CASE("render: --error makes the same bytes whoever traces them") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars);
    const auto pixels = [&](std::vector<std::string> words) {
        const ProgramResult made = run_program(render_words(std::move(words), scene));
        REQUIRE(made.status == 0);
        return pixels_of(made.out);
    };
    const std::string one = pixels({"--error", ".05"});
    CHECK(pixels({"--error", ".05", "-n", "3", "--block", "16"}) == one);
    CHECK(pixels({"--error", ".05", "--samples", "4"}) == one);
    CHECK(pixels({"--error", ".05", "--samples", "8"}) != one);
    CHECK(pixels({"--error", ".05", "--seed", "7"}) != one);
    const std::string sharp = pixels({"--error", ".05", "--pixel-filter", "mitchell"});
    CHECK(sharp != one);
    CHECK(pixels({"--error", ".05", "--pixel-filter", "mitchell", "-n", "3", "--block", "16"}) ==
          sharp);
    CHECK(pixels({"--error", ".05", "-ab", "1", "--deterministic"}) ==
          pixels({"--error", ".05", "-ab", "1", "--deterministic", "-n", "2"}));
}

TEST_CASE("render: an .exr of --error holds each pixel's error, and the picture as without") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars), file = folder.path("a.exr");
    REQUIRE(run_program(render_words({"--error", ".1", "-o", file}, scene)).status == 0);
    const std::string bytes = read_whole(file);
    CHECK(bytes.find("error") < 400);  // in the head
    const LayersHeader header = read_layers_header(bytes, file);
    REQUIRE(header.names == std::vector<std::string>{"a"});  // no layer of light
    Picture sum{header.width, header.height, std::vector<Rgb>(48 * 32)};
    const std::vector<Rgb> once{{1, 1, 1}};
    add_layers(bytes, file, once, sum);
    const Picture other =
        read_hdr(run_program(render_words({"--error", ".1"}, scene)).out, "other");
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        REQUIRE(std::abs(sum.pixels[i].g - other.pixels[i].g) <=
                max_component(other.pixels[i]) / 128);
}

TEST_CASE("render: an .exr of layers holds the whole picture's error as well") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars), file = folder.path("a.exr");
    const auto exr = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"--light-group", "lamp=lamp", "-o", file});
        REQUIRE(run_program(render_words(std::move(words), scene)).status == 0);
        return read_whole(file);
    };
    const std::string bytes = exr({"--error", ".1"});
    const auto channel = [](const std::string& of) { return of.find(std::string("error\0", 6)); };
    CHECK(channel(bytes) < 400);  // in the head
    CHECK(channel(exr({"--samples", "4"})) == std::string::npos);
    const LayersHeader header = read_layers_header(bytes, file);
    CHECK(std::ranges::find(header.names, "error") == header.names.end());  // no layer of light
    CHECK(std::ranges::find(header.names, "lamp") != header.names.end());
    const auto sum = [&](const std::string& made, std::size_t layers) {
        Picture picture{48, 32, std::vector<Rgb>(48 * 32)};
        add_layers(made, file, std::vector<Rgb>(layers, {1, 1, 1}), picture);
        return picture.pixels;
    };
    REQUIRE(run_program(render_words({"--error", ".1", "-o", file}, scene)).status == 0);
    const std::vector<Rgb> whole = sum(read_whole(file), 1);
    const std::vector<Rgb> layers = sum(bytes, header.names.size());
    for (std::size_t i = 0; i < whole.size(); ++i)  // the same samples
        REQUIRE(layers[i].g == doctest::Approx(whole[i].g).epsilon(1e-4));
}

TEST_CASE("render: --pixel-filter goes with --error, and nothing is negative") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("lamps.rad",
                                           "void light lamp 0 0 3 200 200 200\n"
                                           "lamp sphere s 0 0 4 0 0 1.5 .3\n");
    const auto picture = [&](std::vector<std::string> words, const std::string& file) {
        words.insert(words.end(), {"--pixel-filter", "mitchell", "-o", folder.path(file)});
        REQUIRE(run_program(render_words(std::move(words), scene)).status == 0);
        const std::string bytes = read_whole(folder.path(file));
        Picture sum{48, 32, std::vector<Rgb>(48 * 32)};
        add_layers(bytes, file, std::vector<Rgb>{{1, 1, 1}}, sum);
        return sum;
    };
    for (const Picture& made :
         {picture({"--error", ".1"}, "a.exr"), picture({"--samples", "8"}, "b.exr")}) {
        float least = 1, most = 0;
        for (const Rgb& pixel : made.pixels) {
            least = std::min(least, min_component(pixel));
            most = std::max(most, max_component(pixel));
        }
        CHECK(least == 0);
        CHECK(most > 202);  // brighter than the lamp beside its edge: it is Mitchell's
    }
}

TEST_CASE("render: --time is a limit beside --error, and the picture is whole") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars), stats = folder.path("s.json");
    const ProgramResult made =
        run_program(render_words({"--error", ".0001", "--time", ".2", "--stats", stats}, scene));
    REQUIRE(made.status == 0);
    CHECK(made.err.empty());
    CHECK(sampling_of(stats).at("error").get<double>() > .0001);
    const Picture picture = read_hdr(made.out, "picture");
    CHECK(std::all_of(picture.pixels.begin(), picture.pixels.begin() + 48 * 4,
                      [](const Rgb& pixel) { return pixel.g >= 0; }));
    CHECK(std::all_of(picture.pixels.end() - 48 * 8, picture.pixels.end(),
                      [](const Rgb& pixel) { return pixel.g > 0; }));
}

TEST_CASE("render: what does not go with --error and --time is told before any work") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars);
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"--error", "-1"}, "option --error: expected"},
        {{"--error", "2"}, "option --error: expected"},
        {{"--error", "nan"}, "option --error: expected"},
        {{"--time", "soon"}, "option --time: expected"},
        {{"--error", ".1", "--checkpoint", folder.path("c")}, "option --checkpoint: "},
        {{"--error", ".1", "--pixel-filter", "box"}, "option --pixel-filter: expected"},
        {{"--pixel-filter", "mitchell"}, "option --pixel-filter: there is nothing to filter"},
        {{"--samples", "4", "--pixel-filter", "mitchell", "--denoise", "-o", folder.path("a.png")},
         "option --pixel-filter: pixels that are denoised"}};
    for (const auto& [words, message] : cases) {
        CAPTURE(message);
        const ProgramResult result = run_program(render_words(words, scene));
        CHECK(result.status == 2);
        CHECK(result.err.find(message) != std::string::npos);
    }
    std::vector<std::string> walk =
        render_words({"--error", ".1", "-o", folder.path("f%d.hdr")}, scene);
    walk.front() = "animate";
    walk.insert(walk.end() - 1, {"--rotate", "2"});
    const ProgramResult refused = run_program(walk);
    CHECK(refused.status == 2);
    CHECK(refused.err.find("say --reuse off") != std::string::npos);
    walk = render_words(
        {"--samples", "2", "--pixel-filter", "mitchell", "-o", folder.path("f%d.hdr")}, scene);
    walk.front() = "animate";
    walk.insert(walk.end() - 1, {"--rotate", "2"});
    const ProgramResult blurred = run_program(walk);
    CHECK(blurred.status == 2);
    CHECK(blurred.err.find("say --reuse off") != std::string::npos);
    CHECK(folder.files() == std::vector<std::string>{"room.rad"});
}

TEST_CASE("render: each picture of a sequence is drawn until it is good") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kBars);
    std::vector<std::string> words =
        render_words({"--error", ".1", "-S", "1", "-o", folder.path("f%d.hdr")}, scene);
    const ProgramResult made = run_program(words, "rvu -vp 0 -6 1.5\nrvu -vp .5 -6 1.5\n");
    REQUIRE(made.status == 0);
    const std::string alone = run_program(render_words({"--error", ".1"}, scene)).out;
    CHECK(pixels_of(read_whole(folder.path("f1.hdr"))) == pixels_of(alone));
    CHECK(pixels_of(read_whole(folder.path("f2.hdr"))) != pixels_of(alone));
}
