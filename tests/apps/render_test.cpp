// lightwalk render, from outside.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "io/ambient/ambient_file.h"
#include "io/picture/picture.h"
#include "tests/apps/program.h"
#include "tests/one_thread.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 .1 .1
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
floor sphere ball 0 0 4 0 0 1 1
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

std::vector<std::string> line(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "-vp", "0",  "-6", "2",   "-vd", "0",   "1", "-.2",
                                   "-x",     "48",  "-y", "32", "-vh", "45",  "-vv", "31"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string pixel_bytes(const std::string& picture) {
    return picture.substr(picture.find("\n\n"));
}

std::vector<std::string> header_lines(const std::string& picture) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < picture.size() && picture[at] != '\n';) {
        const std::size_t end = picture.find('\n', at);
        lines.push_back(picture.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

}  // namespace

TEST_CASE(
    "render: the same bytes with any number of threads and executor, on standard output or in a "
    "file") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const ProgramResult one = run_program(line({"-n", "1", "--executor", "serial", scene}));
    REQUIRE(one.err.empty());
    REQUIRE(one.status == 0);
    for (const std::vector<std::string>& how : {std::vector<std::string>{"-n", "4"},
                                                {"-n", "3", "--executor", "threads"},
                                                {"-n", "2", "-ps", "4"}}) {
        std::vector<std::string> words = how;
        words.push_back(scene);
        CHECK(pixel_bytes(run_program(line(words)).out) == pixel_bytes(one.out));
    }
    const ProgramResult file = run_program(line({"-o", folder.path("a.hdr"), scene}));
    CHECK(file.status == 0);
    CHECK(file.out.empty());
    CHECK(pixel_bytes(read_whole(folder.path("a.hdr"))) == pixel_bytes(one.out));
    const Picture picture = read_hdr(one.out, "one");
    CHECK(picture.width == 48);
    CHECK(picture.height == 32);
    const auto brightest = std::max_element(picture.pixels.begin(), picture.pixels.end(),
                                            [](const Rgb& a, const Rgb& b) { return a.g < b.g; });
    CHECK(brightest->g > 0.1f);
}

TEST_CASE("render: --samples traces every pixel, and says so when -ps asked for less") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const ProgramResult samples = run_program(line({"--samples", "3", "-n", "1", scene}));
    CHECK(samples.status == 0);
    CHECK(samples.err.empty());
    const ProgramResult spaced =
        run_program(line({"--samples", "3", "-ps", "4", "-pj", "0", "-n", "3", scene}));
    CHECK(spaced.status == 0);
    CHECK(spaced.err.find("-ps ignored: every pixel is traced where they have several rays") !=
          std::string::npos);
    CHECK(pixel_bytes(spaced.out) == pixel_bytes(samples.out));
    CHECK(run_program(line({"--samples", "3", "-ps", "1", scene})).err.empty());
    const std::string single = run_program(line({"-ps", "4", scene})).out;
    CHECK(pixel_bytes(run_program(line({"--samples", "1", "-ps", "4", scene})).out) ==
          pixel_bytes(single));
    CHECK(pixel_bytes(samples.out) != pixel_bytes(single));
}

TEST_CASE("render: --tone changes .png alone") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto bytes = [&](const std::string& name, const std::string& tone) {
        CHECK(run_program(line({"--tone", tone, "-o", folder.path(name), scene})).status == 0);
        return read_whole(folder.path(name));
    };
    CHECK(bytes("a.png", "curve") != bytes("a.png", "linear"));
    CHECK(pixel_bytes(bytes("a.hdr", "curve")) == pixel_bytes(bytes("a.hdr", "linear")));
}

TEST_CASE(
    "render: the header holds history without the scene, software, view, dates and primaries, in "
    "this order") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string options = folder.write("options", "-av .1 .1 .1");
    const std::string out = run_program(line({"-pa", "2", "@" + options, scene, "-ps", "2"})).out;
    const std::vector<std::string> lines = header_lines(out);
    REQUIRE(lines.size() == 9);
    CHECK(lines[0] == "#?RADIANCE");
    CHECK(lines[1] ==
          "lightwalk render -vp 0 -6 2 -vd 0 1 -.2 -x 48 -y 32 -vh 45 -vv 31 -pa 2 -av .1 .1 .1 "
          "-ps 2");
    CHECK(lines[2].starts_with("SOFTWARE= Lightwalk"));
    CHECK(lines[3].starts_with("VIEW= -vtv -vp 0 -6 2 -vd 0 1 -0.2"));
    CHECK(lines[4] == "PIXASPECT=2.000000");
    CHECK(lines[5].starts_with("CAPDATE= 2"));
    CHECK(lines[6].starts_with("GMT= 2"));
    CHECK(lines[7] == "PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333");
    CHECK(lines[8] == "FORMAT=32-bit_rle_rgbe");
    CHECK(out.find("\n\n-Y ") != std::string::npos);
}

TEST_CASE("render: -pXYZ writes the same picture as XYZE, without primaries") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const Picture rgb = read_hdr(run_program(line({scene})).out, "rgb");
    const std::string out = run_program(line({"-pXYZ", scene})).out;
    CHECK(header_lines(out).back() == "FORMAT=32-bit_rle_xyze");
    CHECK(out.find("PRIMARIES") == std::string::npos);
    const Picture xyz = read_hdr(out, "xyz");
    REQUIRE(xyz.pixels.size() == rgb.pixels.size());
    for (std::size_t i = 0; i < rgb.pixels.size(); ++i) {
        // Half a step of 1/128 of the largest channel, before and after a change of colours whose
        // largest row adds up to 4.2.
        const float limit = .5f * (1 + 4.2f) / 128 * max_component(rgb.pixels[i]);
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(xyz.pixels[i][k] - rgb.pixels[i][k]) <= limit);
    }
    CHECK(header_lines(run_program(line({"-pXYZ", "-pRGB", scene})).out).back() ==
          "FORMAT=32-bit_rle_rgbe");
    CHECK(run_program(line({"-pXYZ", "-o", folder.path("a.png"), scene}))
              .err.find("option -pXYZ: only Radiance pictures") != std::string::npos);
}

TEST_CASE("render: a wrong command line says what is wrong, exits with 2 and writes nothing") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string out = folder.path("out.hdr");
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"-aq", "1"}, "unknown option -aq, did you mean -ae?"},
        {{"--exposre", "1"}, "did you mean --exposure?"},
        {{"--samples", "0"}, "option --samples: expected a number from 1 to 65536"},
        {{"--sample-lights", "-1"}, "option --sample-lights: expected auto or a number of lights"},
        {{"--exposure", "bright"}, "option --exposure: expected auto or a number of stops"},
        {{"--tone", "flat"}, "option --tone: expected curve or linear, found \"flat\""},
        {{"-x", "3.5"}, "option -x: expected an integer, found \"3.5\""},
        {{"-vp", "1", "2"}, "-vp"},
        {{"-n", "0"}, "option -n: expected 1 to 4096 threads, found 0"},
        {{"-r", "old.hdr"}, "option -r"},
        {{"-ap", "map"}, "option -ap names a photon map"},
        {{"-pS"}, "option -pS weights colours by another eye"},
        {{"-cs", "9"}, "option -cs is about spectral rendering"},
        {{"-lr", "0", "-lw", "0"}, "option -lw"},
        {{"-o", "a%s.hdr"}, "a%s.hdr"},
        {{"@/no/such/file"}, "cannot expand '@/no/such/file'"},
    };
    for (const auto& [options, message] : cases) {
        std::vector<std::string> words{"-o", out, scene};
        words.insert(words.end(), options.begin(), options.end());
        const ProgramResult result = run_program(line(words));
        CAPTURE(message);
        CHECK(result.status == 2);
        CHECK(result.out.empty());
        CHECK(result.err.find(message) != std::string::npos);
        CHECK(result.err.find("Try 'lightwalk render --help'.") != std::string::npos);
    }
    CHECK(run_program({"render"}).status == 2);
    CHECK(folder.files() == std::vector<std::string>{"room.rad"});
}

TEST_CASE("render: bad input is told with file and line, status 1, and nothing is written") {
    const TemporaryFolder folder;
    const std::string bad =
        folder.write("bad.rad", "void plastic red 0 0 5 1 0 0 0 0\n\nrd sphere s 0 0 4 0 0 0 1\n");
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string> before = folder.files();
    const ProgramResult result = run_program(line({"-o", folder.path("out.hdr"), bad}));
    CHECK(result.status == 1);
    CHECK(result.err.find(bad + ":3: ") != std::string::npos);
    CHECK(run_program(line({"-o", folder.path("out.hdr"), folder.path("missing.rad")})).status ==
          1);
    CHECK(run_program(line({"-o", folder.path("none/out.hdr"), scene})).status == 1);
    CHECK(run_program(line({"-o", folder.path("out.tiff"), scene})).status == 1);
    CHECK(run_program(line({"-vd", "0", "0", "0", "-o", folder.path("out.hdr"), scene})).status ==
          1);
    CHECK(run_program(line({"-vf", folder.path("no.vf"), "-o", folder.path("out.hdr"), scene}))
              .status == 1);
    CHECK(folder.files() == before);
}

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr double kPatience = 60;  // [s] sanitizers hold signals back
#else
constexpr double kPatience = 10;  // it is .7 s; no machine is so busy  // [s]
#endif

TEST_CASE("render: Ctrl-C ends within a second with status 130 and leaves no picture") {
    const TemporaryFolder folder;
    const std::string many_pixels = folder.write("room.rad", kRoom);
    std::string panes = "void dielectric water 0 0 5 1 1 1 1.5 0\n";
    for (int i = 0; i < 200; ++i) {  // each splits the ray in two: a pixel that never ends
        const std::string z = ' ' + std::to_string(-0.01 * i) + ' ';
        panes += "water polygon p 0 0 12 -9 -9" + z + "9 -9" + z + "9 9" + z + "-9 9" + z + '\n';
    }
    const std::string endless_pixel = folder.write("panes.rad", panes);
    for (const std::string& scene : {many_pixels, endless_pixel}) {
        CAPTURE(scene);
        RunningProgram program({"render",
                                "-x",
                                "8000",
                                "-y",
                                "8000",
                                "-ps",
                                "1",
                                "-lw",
                                "0",
                                "-lr",
                                "2000",
                                "-o",
                                folder.path("big.hdr"),
                                "-z",
                                folder.path("big.z"),
                                "-vp",
                                "0",
                                "0",
                                "3",
                                "-vd",
                                "0",
                                ".1",
                                "-1",
                                scene});
        std::this_thread::sleep_for(std::chrono::milliseconds(700));
        const auto start = std::chrono::steady_clock::now();
        program.interrupt();
        const ProgramResult result = program.finish();
        const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
        CHECK(result.status == 130);
        CHECK(waited.count() < kPatience);
    }
    CHECK(folder.files() == std::vector<std::string>{"panes.rad", "room.rad"});
}

TEST_CASE("render: --stats tells times, rays by kind, threads and memory") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string stats = folder.path("stats.json");
    REQUIRE(run_program(
                line({"-ps", "1", "-n", "2", "--stats", stats, "-o", folder.path("a.hdr"), scene}))
                .status == 0);
    const nlohmann::json json = nlohmann::json::parse(read_whole(stats));
    CHECK(json["rays"]["primary"] == 48 * 32);
    CHECK(json["rays"]["shadow"] > 1000);
    double sum = 0;
    for (const char* kind : {"primary", "shadow", "specular", "transmitted", "ambient"})
        sum += json["rays"][kind].get<double>();
    CHECK(json["rays"]["total"] == sum);
    CHECK(json["threads"] == 2);
    CHECK(json["peak_memory_bytes"] > 1000000);
    CHECK(json["rays_per_second"] > 0);
    for (const char* step : {"read", "build", "render"}) CHECK(json["seconds"][step] >= 0);
    CHECK(json["picture"]["width"] == 48);
    CHECK(json["version"].is_string());
}

TEST_CASE("render: -t reports tell of the prepass, too, and neither shares nor rays ever fall") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string stats = folder.path("s.json");
    const ProgramResult result =
        run_program(line({"-ab", "1", "-ad", "256", "-aa", ".1", "-ps", "1", "-t", "1e-6",
                          "--stats", stats, "-n", "2", scene}));
    REQUIRE(result.status == 0);
    std::istringstream lines(result.err);
    std::vector<double> shares;
    double last_rays = 0;
    for (std::string text; std::getline(lines, text);) {
        CAPTURE(text);
        double rays = 0, share = 0;
        REQUIRE(std::sscanf(text.c_str(), "lightwalk render: %lf rays, %lf%%", &rays, &share) == 2);
        CHECK(rays >= last_rays);
        if (!shares.empty()) CHECK(share >= shares.back());
        shares.push_back(share);
        last_rays = rays;
    }
    REQUIRE(shares.size() > 10);
    CHECK(shares.front() == 0);
    CHECK(shares.back() == 100);
    const nlohmann::json json = nlohmann::json::parse(read_whole(stats));
    CHECK(last_rays == json["rays"]["total"].get<double>());
}

TEST_CASE(
    "render: -ab adds indirect light, --deterministic with the same bytes for any number of "
    "threads") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto render = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"-ad", "64", "-as", "0", scene});
        const ProgramResult result = run_program(line(words));
        CAPTURE(result.err);
        REQUIRE(result.status == 0);
        CHECK(result.err.empty());
        return pixel_bytes(result.out);
    };
    const std::string direct = render({"-ab", "0"}),
                      one = render({"-ab", "2", "-n", "1", "--deterministic"});
    CHECK(one != direct);
    CHECK(render({"-ab", "2", "-n", "2", "--deterministic"}) == one);
    CHECK(render({"-ab", "2", "-n", "7", "--deterministic"}) == one);
    CHECK(run_program(line({"--overture", "never", scene})).status == 2);
}

TEST_CASE("render: -af keeps values for the next run, and uses those of other options") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom), file = folder.path("room.amb");
    const auto render = [&](const std::string& accuracy) {
        return run_program(line({"-ab", "1", "-ad", "64", "-as", "0", "-aa", accuracy, "-af", file,
                                 "-ps", "1", "--stats", folder.path("s.json"), scene}));
    };
    const auto computed = [&] {
        return nlohmann::json::parse(read_whole(folder.path("s.json")))["ambient"]["computed"]
            .get<int>();
    };
    CHECK(render(".1").status == 0);
    CHECK(computed() > 10);
    const std::size_t size = read_whole(file).size();
    CHECK(render(".1").status == 0);
    CHECK(computed() == 0);
    CHECK(read_whole(file).size() == size);
    const ProgramResult other = render(".2");
    CHECK(other.status == 0);
    CHECK(other.err.find("made with -aa 0.1 (not 0.2): ") != std::string::npos);
    CHECK(computed() <= 2);  // what served the finer run serves the coarser one, but for its rim
    std::filesystem::resize_file(file, size - 5);  // as a killed run may leave it
    const ProgramResult torn = render(".1");
    CHECK(torn.status == 0);
    CHECK(torn.err.find("the last record is incomplete") != std::string::npos);
    CHECK(computed() >= 1);
    const ProgramResult info = run_program({"info", file});
    CHECK(info.status == 0);
    CHECK(info.out.find("values ") != std::string::npos);
    CHECK(info.out.find("level 0") != std::string::npos);
    folder.write("bad.amb", "what is this");
    CHECK(run_program(line({"-ab", "1", "-af", folder.path("bad.amb"), scene})).status == 1);
}

TEST_CASE("render: killed at twenty moments, every whole ambient value is there for the next run" *
          about_numbers) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom), file = folder.path("room.amb");
    const auto words = [&](const std::string& picture) {
        return line({"--quiet",
                     "-ab",
                     "1",
                     "-ad",
                     "1024",
                     "-as",
                     "0",
                     "-aa",
                     ".05",
                     "-ar",
                     "256",
                     "-ps",
                     "1",
                     "-pj",
                     "0",
                     "-x",
                     "160",
                     "-y",
                     "120",
                     "-af",
                     file,
                     "-o",
                     folder.path(picture),
                     scene});
    };
    std::size_t before = 0;
    int patience = 1;
    for (int i = 0; i < 20 || (before == 0 && i < 32); ++i) {
        {
            const RunningProgram run(words("killed.hdr"));
            std::this_thread::sleep_for(std::chrono::milliseconds(10 + 37 * i % 90) * patience);
        }                                              // SIGKILL
        if (before == 0 && i % 4 == 3) patience *= 2;  // it was still reading the scene
        const std::string bytes = std::filesystem::exists(file) ? read_whole(file) : std::string();
        if (bytes.empty()) continue;
        const AmbientFile contents = decode_ambient_file(bytes, file);
        CHECK((contents.damage.empty() || contents.damage == "the last record is incomplete"));
        CHECK(contents.records.size() >= before);
        before = contents.records.size();
    }
    CHECK(before > 0);
    const ProgramResult last = run_program(words("last.hdr"));
    CAPTURE(last.err);
    REQUIRE(last.status == 0);
    CHECK(decode_ambient_file(read_whole(file), file).damage.empty());
    std::filesystem::remove(file);
    REQUIRE(run_program(words("fresh.hdr")).status == 0);
    const Picture a = read_hdr(read_whole(folder.path("last.hdr")), "last.hdr"),
                  b = read_hdr(read_whole(folder.path("fresh.hdr")), "fresh.hdr");
    double sum_a = 0, sum_b = 0;
    for (const Rgb& c : a.pixels) sum_a += static_cast<double>(c.g);
    for (const Rgb& c : b.pixels) sum_b += static_cast<double>(c.g);
    CHECK(sum_a == doctest::Approx(sum_b).epsilon(0.01));
}

TEST_CASE("render: -defaults shows every value after the options before it") {
    const ProgramResult result =
        run_program({"render", "-ab", "3", "-dv-", "-defaults", "-ab", "1"});
    CHECK(result.status == 0);
    for (const std::string text :
         {"-ab 3\t", "-dv-\t", "-ps 4\t", "-pt 0.050000\t", "-pj 0.670000\t", "-x 512\t", "-vtv\t",
          "-vp 0.000000 0.000000 0.000000\t"}) {
        CAPTURE(text);
        CHECK(result.out.find(text) != std::string::npos);
    }
}

TEST_CASE("render: -S makes a numbered picture of each view line, and skips those that are there") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string views = "rvu -vp 0 -6 2\nnothing\nVIEW= -vp 0 -5 2\nrvu -vh 30\n";
    const std::vector<std::string> words =
        line({"-S", "7", "-pm", ".5", "-o", folder.path("f%02d.hdr"), "-z", folder.path("f%02d.z"),
              scene});
    folder.write("f08.hdr", "mine");
    CHECK(run_program(words, views).status == 0);
    CHECK(folder.files() ==
          std::vector<std::string>{"f07.hdr", "f07.z", "f08.hdr", "f09.hdr", "f09.z", "room.rad"});
    CHECK(read_whole(folder.path("f08.hdr")) == "mine");
    CHECK(read_whole(folder.path("f09.hdr")).find("\nFRAME=9\nVIEW= -vtv -vp 0 -5 2 ") !=
          std::string::npos);
    CHECK(run_program(words, "nothing\n").err.find("no output produced") != std::string::npos);
}

TEST_CASE("render: distances are raw floats from the top") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string depth = folder.path("a.z");
    const ProgramResult exr =
        run_program(line({"-ps", "1", "-pj", "0", "-z", depth, "-o", folder.path("a.exr"), scene}));
    CAPTURE(exr.err);
    REQUIRE(exr.status == 0);
    const std::string bytes = read_whole(depth);
    REQUIRE(bytes.size() == 48 * 32 * sizeof(float));
    std::vector<float> z(48 * 32);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(z.data()));
    CHECK(z[0] == 1e10f);        // sky
    CHECK(z[16 * 48 + 24] < 6);  // the ball
    CHECK(z[31 * 48 + 24] < 9);  // the floor
}

TEST_CASE("render: an empty picture is a header with a warning") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const ProgramResult result = run_program({"render", "-x", "0", scene});
    CHECK(result.status == 0);
    CHECK(result.err.find("empty output picture") != std::string::npos);
    CHECK(result.out.find("-Y        0 +X        0") != std::string::npos);
}
