// lightwalk contrib, from outside. Reference values: Radiance's rcontrib 6.0a on the same scene,
// which has no glossy plastic: 6.0a reflects otherwise than 6.1a there, by some thousandths.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/one_thread.h"
#include "tests/tolerance.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void light lamp 0 0 3 10 20 30
lamp polygon l1 0 0 12 -.5 -.5 3 -.5 .5 3 .5 .5 3 .5 -.5 3
void light bulb 0 0 3 5 5 5
bulb sphere l2 0 0 4 2 0 3 .2
void glow sky 0 0 4 1 2 3 0
sky source skyd 0 0 4 0 0 1 180
void light sun 0 0 3 1000 900 800
sun source s 0 0 4 .2 .3 1 .5
void plastic floor 0 0 5 .5 .4 .3 0 0
floor polygon f 0 0 12 -5 -5 0 5 -5 0 5 5 0 -5 5 0
void mirror mir 0 0 3 .8 .8 .8
mir polygon m 0 0 12 4 3 0 4 -3 0 4 -3 4 4 3 4
void glass pane 0 0 3 .9 .8 .7
pane polygon g 0 0 12 -5 -5 4 5 -5 4 5 5 4 -5 5 4
void mixfunc mixed 4 mir floor .25 . 0 0
mixed polygon w 0 0 12 -4 -4 0 -4 -4 3 -1 -4 3 -1 -4 0
void illum veil 1 void 0 3 2 2 2
veil polygon v 0 0 12 -3 2 .5 -1 2 .5 -1 2 2 -3 2 2
)";

const std::string kRays = R"(
0 0 1 0 0 -1
0 0 1 .1 .1 1
1 1 1 .3 .2 -1
-2 1 1.5 -1 -.3 1
0 0 1.2 1 .3 .5
-2 0 1 -.1 -1 -.1
0 0 3.5 0 0 -1
-2 0 1 .1 1 .1
)";

constexpr std::size_t kRayCount = 8;
constexpr std::size_t kColumns = 21;  ///< numbers of kModifiers for a ray

/// With which nothing is random.
const std::vector<std::string> kExact{"-ab", "0", "-ds", "0",    "-dj", "0",
                                      "-dr", "1", "-lw", "1e-6", "-lr", "8"};

/// A run in a folder with the scene room.rad.
ProgramResult contrib(const TemporaryFolder& folder, const std::vector<std::string>& words,
                      const std::string& rays = kRays, const std::string& scene = kRoom,
                      const std::vector<std::string>& launcher = {}) {
    std::vector<std::string> all{"contrib"};
    all.insert(all.end(), kExact.begin(), kExact.end());
    all.insert(all.end(), words.begin(), words.end());
    all.push_back(folder.write("room.rad", scene));
    return run_program(all, rays, launcher);
}

std::vector<double> numbers(const std::string& text) {
    std::istringstream in(text);
    std::vector<double> values;
    for (double value = 0; in >> value;) values.push_back(value);
    return values;
}

void check_values(const std::string& text, const std::vector<double>& expected) {
    const std::vector<double> found = numbers(text);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(found[i] - expected[i]) <= 1e-5 * std::abs(expected[i]));
    }
}

/// What follows the header.
std::string data_of(const std::string& file) {
    const std::string bytes = read_whole(file);
    return bytes.substr(bytes.find("\n\n") + 2);
}

bool exists(const std::string& path) {
    return std::filesystem::exists(path);
}

// clang-format off
/// Of lamp, bulb, sky, sun, floor, mixed and veil, in this order, for each ray.
const std::vector<double> kCoefficients{
    0.01789892, 0.01431913, 0.01073935, 0.001439087, 0.001151269, 0.0008634521, 0, 0, 0, 7.375126e-06, 5.226881e-06, 3.41734e-06, 1.0, 1.0, 1.0, 0, 0, 0, 0.01313954, 0.01051163, 0.007883725,
    1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0.01010942, 0.008087539, 0.006065654, 0.001919143, 0.001535314, 0.001151486, 0, 0, 0, 7.375126e-06, 5.226881e-06, 3.41734e-06, 1.0, 1.0, 1.0, 0, 0, 0, 0.002848412, 0.002278729, 0.001709047,
    0, 0, 0, 0, 0, 0, 0.7978257, 0.697264, 0.5986462, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0.5613058, 0.4829147, 0.4077266, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0.002172032, 0.001737626, 0.001303219, 0.0003434212, 0.000274737, 0.0002060527, 0, 0, 0, 3.134429e-06, 2.221425e-06, 1.452369e-06, 0.2, 0.2, 0.2, 1.0, 1.0, 1.0, 0.009918067, 0.007934453, 0.00595084,
    1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1.0, 1.0, 1.0};
const std::vector<double> kValues{
    0.1789892, 0.2863827, 0.3221805, 0.007195433, 0.005756347, 0.00431726, 0, 0, 0, 0.007375126, 0.004704193, 0.002733872, 0.2198388, 0.3178665, 0.3449991, 0, 0, 0, 0.02627908, 0.02102327, 0.01576745,
    10.0, 20.0, 30.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0.1010942, 0.1617508, 0.1819696, 0.009595715, 0.007676572, 0.005757429, 0, 0, 0, 0.007375126, 0.004704193, 0.002733872, 0.1237619, 0.178689, 0.193879, 0, 0, 0, 0.005696824, 0.004557459, 0.003418094,
    0, 0, 0, 0, 0, 0, 0.7978257, 1.394528, 1.795938, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0.5613058, 0.9658295, 1.22318, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0.02172032, 0.03475251, 0.03909658, 0.001717106, 0.001373685, 0.001030264, 0, 0, 0, 0.003134429, 0.001999282, 0.001161896, 0.007830454, 0.01086248, 0.01161598, 0.04640799, 0.05399439, 0.05319043, 0.01983613, 0.01586891, 0.01190168,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 1.0, 2.0, 3.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1.0, 2.0, 3.0};
/// Irradiances of lamp, bulb and sun.
const std::vector<double> kIrradiances{
    0, 0, 0, 0, 0, 0, 0, 0, 0,
    0.2485204, 0.2485204, 0.2485204, 0.01312098, 0.01312098, 0.01312098, 4.817687e-05, 4.267973e-05, 3.72054e-05,
    0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 2.275802e-05, 2.016126e-05, 1.757527e-05,
    0.1357542, 0.1357542, 0.1357542, 0.01859917, 0.01859917, 0.01859917, 3.162452e-05, 2.801607e-05, 2.442258e-05,
    0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0.007400358, 0.007400358, 0.007400358, 0, 0, 0,
    0.01254965, 0.01254965, 0.01254965, 0.001012038, 0.001012038, 0.001012038, 1.927075e-05, 1.707189e-05, 1.488216e-05};
// clang-format on

const std::vector<std::string> kModifiers{"-m",  "lamp", "-m",    "bulb", "-m",    "sky", "-m",
                                          "sun", "-m",   "floor", "-m",   "mixed", "-m",  "veil"};

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_CASE("contrib: coefficients, contributions and irradiances are rcontrib's") {
    const TemporaryFolder folder;
    const ProgramResult coefficients = contrib(folder, with({"-h-"}, kModifiers));
    CHECK(coefficients.status == 0);
    check_values(coefficients.out, kCoefficients);
    check_values(contrib(folder, with({"-h-", "-V+"}, kModifiers)).out, kValues);
    check_values(contrib(folder, {"-h-", "-I+", "-m", "lamp", "-m", "bulb", "-m", "sun"}).out,
                 kIrradiances);
    // A light source alone is told of without watching every ray.
    std::vector<double> lamp;
    for (std::size_t i = 0; i < kCoefficients.size(); i += kColumns)
        lamp.insert(lamp.end(), kCoefficients.begin() + static_cast<std::ptrdiff_t>(i),
                    kCoefficients.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    check_values(contrib(folder, {"-h-", "-m", "lamp"}).out, lamp);
}

TEST_CASE("contrib: bins are chosen by direction and place, and those beyond the last left out") {
    const TemporaryFolder folder;
    folder.write("quarters.cal", "quarter(x, y) = if(x,1,0) + S*if(y,1,0);\nN : 4;");
    const ProgramResult sky =
        contrib(folder, {"-h-", "-e", "S=1", "-f", folder.path("quarters.cal"), "-p", "S=2", "-b",
                         "quarter(Dx,Dy)", "-bn", "N", "-m", "sky"});
    CHECK(sky.status == 0);
    const std::vector<double> bins = numbers(sky.out);
    REQUIRE(bins.size() == kRayCount * 12);
    for (std::size_t ray = 0; ray < kRayCount; ++ray) {
        for (std::size_t bin = 0; bin < 4; ++bin) {
            CAPTURE(ray);
            CAPTURE(bin);
            const bool here =
                (ray == 3 && bin == 0) || (ray == 4 && bin == 2) || (ray == 7 && bin == 3);
            const double expected = here ? kCoefficients[ray * kColumns + 6] : 0;
            CHECK(bins[ray * 12 + bin * 3] == doctest::Approx(expected).epsilon(1e-5));
        }
    }
    // The sun is met where its ray left the pane: at x from .5 to 1.5 there, rounded.
    const ProgramResult sun =
        contrib(folder, {"-h-", "-b", "Px+.5", "-bn", "4", "-m", "sun"}, "0 0 1 0 0 -1");
    check_values(sun.out, {0, 0, 0, 7.375126e-06, 5.226881e-06, 3.417340e-06, 0, 0, 0, 0, 0, 0});
    const ProgramResult beyond =
        contrib(folder, {"-h-", "-b", "9", "-bn", "4", "-m", "sun"}, "0 0 1 0 0 -1");
    check_values(beyond.out, std::vector<double>(12));
    CHECK(beyond.status == 0);
    CHECK(beyond.err.find("bin 9 of 4") != std::string::npos);
    check_values(contrib(folder, {"-h-", "-b", "-1", "-bn", "4", "-m", "sun"}, "0 0 1 0 0 -1").out,
                 std::vector<double>(12));
}

TEST_CASE("contrib: files by modifier and bin, with rcontrib's header lines") {
    const TemporaryFolder folder;
    const ProgramResult result =
        contrib(folder, {"-o", folder.path("%s.dat"), "-m", "lamp", "-b", "if(Dx,1,0)", "-bn", "2",
                         "-o", folder.path("%s_%d.dat"), "-m", "sky", "-o",
                         folder.path("all_%03d.dat"), "-m", "bulb", "-m", "sun"});
    CHECK(result.status == 0);
    CHECK(result.out.empty());
    CHECK(folder.files() == std::vector<std::string>{"all_000.dat", "all_001.dat", "lamp.dat",
                                                     "room.rad", "sky_0.dat", "sky_1.dat"});
    const std::string lamp = read_whole(folder.path("lamp.dat"));
    CHECK(lamp.starts_with("#?RADIANCE\nlightwalk contrib -ab 0"));
    CHECK(lamp.find("\nNCOMP=3\nMODIFIER=lamp\nNCOLS=1\nFORMAT=ascii\n\n") != std::string::npos);
    CHECK(read_whole(folder.path("sky_1.dat")).find("\nMODIFIER=sky\nBIN=1\nNCOLS=1\n") !=
          std::string::npos);
    CHECK(read_whole(folder.path("all_000.dat")).find("\nNCOMP=3\nBIN=0\nNCOLS=2\n") !=
          std::string::npos);
    CHECK(numbers(data_of(folder.path("all_000.dat"))).size() == kRayCount * 6);
}

TEST_CASE("contrib: pictures have a resolution line, binary records their size") {
    const TemporaryFolder folder;
    const std::string picture = contrib(folder, {"-fac", "-x", "8", "-y", "1", "-m", "lamp"}).out;
    const std::string end = "NROWS=8\nFORMAT=32-bit_rle_rgbe\n\n-Y        1 +X        8\n";
    const std::size_t at = picture.find(end);
    REQUIRE(at != std::string::npos);
    CHECK(picture.size() == at + end.size() + kRayCount * 4);
    CHECK(contrib(folder, {"-h-", "-fad", "-m", "lamp", "-m", "sun"}).out.size() == kRayCount * 48);
    CHECK(
        contrib(folder, {"-fff", "-m", "lamp"}, std::string(24, '\0')).out.find("BigEndian=0\n") !=
        std::string::npos);
}

TEST_CASE("contrib: -c N averages rays, -c 0 adds them up") {
    const TemporaryFolder folder;
    std::vector<double> means, sum(3);
    const auto at = [](std::size_t ray, std::size_t k) {
        return kCoefficients[kColumns * ray + k];
    };
    for (std::size_t ray = 0; ray < 6; ray += 3)
        for (std::size_t k = 0; k < 3; ++k)
            means.push_back((at(ray, k) + at(ray + 1, k) + at(ray + 2, k)) / 3);
    for (std::size_t k = 0; k < 3; ++k) means.push_back((at(6, k) + at(7, k)) / 2);
    for (std::size_t ray = 0; ray < kRayCount; ++ray)
        for (std::size_t k = 0; k < 3; ++k) sum[k] += at(ray, k);
    const ProgramResult mean = contrib(folder, {"-h-", "-c", "3", "-m", "lamp"});
    check_values(mean.out, means);
    CHECK(mean.err.find("fewer rays") != std::string::npos);
    check_values(contrib(folder, {"-h-", "-c", "0", "-m", "lamp"}).out, sum);
}

TEST_CASE(
    "contrib: what exists is neither replaced nor lost, -r goes on with what is left of a run") {
    const TemporaryFolder folder;
    const std::string file = folder.path("lamp.dat"), part = file + ".part";
    const auto run = [&](const std::vector<std::string>& words) {
        return contrib(folder,
                       with(words, {"-o", folder.path("%s.dat"), "-m", "lamp", "-m", "sun"}));
    };
    for (const char* format : {"-faa", "-faf", "-fad"}) {
        CAPTURE(format);
        CHECK(run({format, "-fo"}).status == 0);
        const std::string whole = read_whole(file), sun = read_whole(folder.path("sun.dat"));
        const ProgramResult again = run({format});
        CHECK(again.status == 1);
        CHECK(again.err.find("lamp.dat: exists already: -fo replaces it") != std::string::npos);
        CHECK(read_whole(file) == whole);
        // A run that was killed while it wrote the last but one record of one of two files.
        std::filesystem::remove(file);
        folder.write("lamp.dat.part", whole.substr(0, whole.size() - 17));
        CHECK(run({format, "-r"}).status == 0);
        CHECK(read_whole(file) == whole);
        CHECK(read_whole(folder.path("sun.dat")) == sun);
        CHECK(!exists(part));
    }
    const ProgramResult other = run({"-faf", "-r"});
    CHECK(other.status == 1);
    CHECK(other.err.find("its format is double, expected float") != std::string::npos);
}

TEST_CASE("contrib: -r with --cache goes on behind the records that are there") {
    const TemporaryFolder folder;
    const std::string open = kRoom.substr(0, kRoom.find("void illum"));
    const auto run = [&](const std::vector<std::string>& more) {
        const std::vector<std::string> words{"--cache", "-ab",  "2",  "-ad",
                                             "1024",    "-fad", "-o", folder.path("sky.dat"),
                                             "-m",      "sky"};
        CHECK(contrib(folder, with(more, words), kRays, open).status == 0);
        return read_whole(folder.path("sky.dat"));
    };
    const std::string whole = run({});
    constexpr std::size_t kRecord = 3 * sizeof(double);
    std::filesystem::remove(folder.path("sky.dat"));
    const std::size_t kept = whole.size() - 3 * kRecord;
    folder.write("sky.dat.part", whole.substr(0, kept + 5));  // killed within a record
    const std::string again = run({"-r"});
    REQUIRE(again.size() == whole.size());
    CHECK(again.substr(0, kept) == whole.substr(0, kept));
    // What is left makes places of its own, whose coefficients differ by noise.
    for (std::size_t i = kept; i < whole.size(); i += sizeof(double)) {
        double first = 0, second = 0;
        std::memcpy(&first, &whole[i], sizeof first);
        std::memcpy(&second, &again[i], sizeof second);
        CHECK(second == within(0.1, first));
    }
}

TEST_CASE("contrib: -r with -c 0 adds to what is there") {
    const TemporaryFolder folder;
    const std::vector<std::string> words{"-c", "0",   "-fad", "-r", "-o", folder.path("sum"),
                                         "-m", "lamp"};
    double once = 0, twice = 0;
    CHECK(contrib(folder, words).status == 0);
    std::memcpy(&once, read_whole(folder.path("sum")).end().base() - 24, sizeof once);
    CHECK(contrib(folder, words).status == 0);
    std::memcpy(&twice, read_whole(folder.path("sum")).end().base() - 24, sizeof twice);
    CHECK(once > 0);
    CHECK(twice == doctest::Approx(2 * once));
}

TEST_CASE("contrib: what is wrong is told, and no file is half-written") {
    const TemporaryFolder folder;
    const auto fails = [&](const std::vector<std::string>& words, int status,
                           const std::string& message, const std::string& rays = kRays) {
        const ProgramResult result = contrib(folder, words, rays);
        CAPTURE(result.err);
        CHECK(result.status == status);
        CHECK(result.err.find(message) != std::string::npos);
        CHECK(result.out.empty());
    };
    fails({}, 2, "no modifier is named");
    fails({"-m", "sky", "-m", "sky"}, 2, "modifier \"sky\" is named twice");
    fails({"-b", "Dx", "-m", "sky"}, 2, "expected -bn N before it");
    fails({"-b", "Dx+", "-bn", "2", "-m", "sky"}, 1, "option -b \"Dx+\"");
    fails({"-b", "nothing", "-bn", "2", "-m", "sky"}, 1, "option -b \"nothing\"");
    fails({"-b", "Nx", "-bn", "2", "-m", "sky"}, 1, "may depend on Px Py Pz and Dx Dy Dz alone");
    fails({"-b", "Dx", "-bn", "0", "-m", "sky"}, 1, "illegal number of bins");
    fails({"-f", "no_such.cal", "-m", "sky"}, 1, "cannot find function file \"no_such.cal\"");
    fails({"-M", folder.path("none"), "-m", "sky"}, 1, "cannot find modifier list");
    fails({"-o", folder.path("none/%s"), "-m", "sky"}, 1, "none/sky.part: cannot open for writing");
    fails({"-o", "%s%s", "-m", "sky"}, 2, "bad output format \"%s%s\"");
    fails({"-o", "%f", "-m", "sky"}, 2, "bad output format \"%f\"");
    fails({"-o", "!cat", "-m", "sky"}, 2, "is a command");
    fails({"-m", "sky", "-o", folder.path("%s")}, 2, "hold for the modifiers behind them");
    fails({"-r", "-m", "sky"}, 2, "it needs files to go on with");
    fails({"--cache", "-b", "Px", "-bn", "2", "-m", "sky"}, 2, "depend on place (Px Py Pz)");
    fails({"--cache", "-ab", "2", "-m", "sky", "-m", "floor"}, 1,
          "modifier \"floor\" is not of light, glow or spotlight");
    fails({"--cache", "-ab", "2", "-m", "veil"}, 1, "modifier \"veil\" is not of light");
    fails({"-af", "x.amb", "-m", "sky"}, 2, "not kept in ambient files");
    fails({"-o", folder.path("%s.dat"), "-m", "sky"}, 1, "standard input:2",
          "0 0 1 0 0 1\n0 0 1 x 0 1\n");
    CHECK(!exists(folder.path("sky.dat")));
    fails({"-fo", "-o", folder.path("%s.dat"), "-x", "4", "-y", "3", "-m", "sky"}, 1,
          "it ends before the rays");
    CHECK(!exists(folder.path("sky.dat")));
    CHECK(contrib(folder, {"-r", "-o", folder.path("%s.dat"), "-x", "8", "-y", "1", "-m", "sky"})
              .status == 1);
    CHECK(contrib(folder, {"-h-", "-m", "nobody"}).err.find("no modifier \"nobody\"") !=
          std::string::npos);
}

TEST_CASE(
    "contrib: with indirect light, contributions add up to what trace sees, with any threads") {
    const TemporaryFolder folder;
    // Without the illum, which brings what it shows and what it lights.
    const std::string open = kRoom.substr(0, kRoom.find("void illum"));
    const std::vector<std::string> indirect{"-h-", "-V+", "-ab", "2", "-ad", "64", "-n"};
    const std::vector<std::string> sources{"-m", "lamp", "-m", "bulb", "-m", "sky", "-m", "sun"};
    const ProgramResult one = contrib(folder, with(with(indirect, {"1"}), sources), kRays, open);
    CHECK(one.status == 0);
    CHECK(contrib(folder, with(with(indirect, {"4"}), sources), kRays, open).out == one.out);
    std::vector<std::string> trace{"trace"};
    trace = with(with(trace, kExact), {"-h", "-dt", "0", "-ab", "2", "-ad", "64", "-aa", "0", "-as",
                                       "0", "-st", ".02", folder.path("room.rad")});
    const std::vector<double> expected = numbers(run_program(trace, kRays).out);
    const std::vector<double> found = numbers(one.out);
    REQUIRE(expected.size() == kRayCount * 3);
    REQUIRE(found.size() == kRayCount * 12);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        double sum = 0;
        for (std::size_t source = 0; source < 4; ++source)
            sum += found[i / 3 * 12 + 3 * source + i % 3];
        CHECK(sum == doctest::Approx(expected[i]).epsilon(1e-5));
    }
}

TEST_CASE("contrib: cached coefficients are traced rays', closer with lower -aa" * about_numbers) {
    const TemporaryFolder folder;
    // The wide ground makes the scene large, so that records may reach far: not through the walls.
    const std::string room = R"(
void glow sky 0 0 4 1 1 1 0
sky source dome 0 0 4 0 0 1 180
void plastic wall 0 0 5 .6 .6 .6 0 0
void plastic ground 0 0 5 .2 .2 .2 0 0
void glass pane 0 0 3 .88 .88 .88
ground ring earth 0 0 8 0 0 -.5 0 0 1 0 100
wall polygon floor 0 0 12 0 0 0 5 0 0 5 8 0 0 8 0
wall polygon ceiling 0 0 12 0 0 3 0 8 3 5 8 3 5 0 3
wall polygon back 0 0 12 0 8 0 5 8 0 5 8 3 0 8 3
wall polygon left 0 0 12 0 0 0 0 8 0 0 8 3 0 0 3
wall polygon right 0 0 12 5 0 0 5 0 3 5 8 3 5 8 0
wall polygon front 0 0 30 0 0 0 0 0 3 5 0 3 5 0 0 1 0 0 1 0 .9 4 0 .9 4 0 2.6 1 0 2.6 1 0 0
pane polygon window 0 0 12 1 0 .9 1 0 2.6 4 0 2.6 4 0 .9
wall polygon table 0 0 12 1 5 .7 4 5 .7 4 6 .7 1 6 .7
)";
    std::string rays;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 8; ++j)
            rays += std::to_string(i + 0.5) + " " + std::to_string(j + 0.5) + " .8 0 0 1\n";
    const auto coefficients = [&](std::vector<std::string> words) {
        const std::vector<std::string> bins{"-h-", "-I", "-ab",        "3",   "-lw", "1e-5", "-lr",
                                            "-10", "-b", "if(Dx,1,0)", "-bn", "2",   "-m",   "sky"};
        return contrib(folder, with(words, bins), rays, room).out;
    };
    struct Sums {
        double all = 0, deep = 0;  ///< of all sensors; of those far from the window
    };
    const auto sums = [&](const std::string& text) {
        const std::vector<double> found = numbers(text);
        REQUIRE(found.size() == 40 * 6);
        Sums s;
        for (std::size_t i = 0; i < found.size(); ++i) {
            s.all += found[i];
            if (i / 6 % 8 >= 4) s.deep += found[i];
        }
        return s;
    };
    const Sums converged = sums(coefficients({"-ad", "4096"}));
    for (const std::string& accuracy : std::vector<std::string>{".1", ".2", ".4"}) {
        for (const std::string& divisions : std::vector<std::string>{"256", "1024"}) {
            CAPTURE(accuracy);
            CAPTURE(divisions);
            const Sums s = sums(coefficients({"--cache", "-aa", accuracy, "-ad", divisions}));
            CHECK(s.all == within(0.03, converged.all));
            CHECK(s.deep == within(0.08, converged.deep));
        }
    }
    const std::string one = coefficients({"--cache", "-ad", "256", "-n", "1"});
    CHECK(one != coefficients({"-ad", "256"}));
    CHECK(coefficients({"--cache", "-ad", "256", "-n", "4"}) == one);
    CHECK(coefficients({"--cache", "-ad", "256", "-n", "3", "--executor", "threads"}) == one);
}

TEST_CASE("contrib: ranks share the rays, and answer the same bytes") {
    const auto launcher = mpirun(3);
    if (!launcher) return;
    const TemporaryFolder folder;
    std::string rays;
    for (int i = 0; i < 40; ++i) rays += kRays;
    const std::vector<std::string> words{"-h-", "-ab", "1",  "-ad", "16", "-b",   "if(Dx,1,0)",
                                         "-bn", "2",   "-m", "sky", "-m", "floor"};
    const ProgramResult alone = contrib(folder, words, rays);
    const ProgramResult shared = contrib(folder, words, rays, kRoom, *launcher);
    if (launcher_died(shared)) return;
    CHECK(shared.status == 0);
    CHECK(!alone.out.empty());
    CHECK(shared.out == alone.out);
}

TEST_CASE("contrib: ranks keep the coefficients of one process, and answer the same bytes") {
    if (!mpirun(2)) return;
    const TemporaryFolder folder;
    std::string rays;
    for (int i = 0; i < 40; ++i) rays += kRays;
    const std::vector<std::string> words{"-h-", "--cache",    "-ab", "2", "-ad", "64",
                                         "-b",  "if(Dx,1,0)", "-bn", "2", "-m",  "sky"};
    const std::string alone = contrib(folder, words, rays).out;
    CHECK(!alone.empty());
    CHECK(alone != contrib(folder,
                           with({"-h-", "-ab", "2", "-ad", "64"},
                                {"-b", "if(Dx,1,0)", "-bn", "2", "-m", "sky"}),
                           rays)
                       .out);
    for (const auto& [ranks, split] : std::vector<std::pair<int, std::vector<std::string>>>{
             {2, {"--variant", "hybrid", "-n", "2"}}, {3, {"--variant", "ranks"}}}) {
        CAPTURE(ranks);
        const ProgramResult shared =
            contrib(folder, with(split, words), rays, kRoom, *mpirun(ranks));
        if (launcher_died(shared)) continue;
        CHECK(shared.status == 0);
        CHECK(shared.out == alone);
    }
}

TEST_CASE("long records come out whole and in order, whatever the format") {
    const TemporaryFolder folder;
    constexpr std::size_t kBins = 3000, kRays = 30;  // 2 MB of answers: several parts
    std::string rays;
    for (std::size_t i = 0; i < kRays; ++i)
        rays += "0 0 10 0 " + std::to_string(i * 0.001) + " 1\n";
    for (const bool wide : {false, true}) {
        const ProgramResult result =
            contrib(folder,
                    {"-h-", wide ? "-fad" : "-faf", "-b", "floor(1000*Dy/Dz+.5)", "-bn",
                     std::to_string(kBins), "-m", "sky"},
                    rays, "void glow sky 0 0 4 1 2 3 0\nsky source skyd 0 0 4 0 0 1 180\n");
        REQUIRE(result.status == 0);
        const std::size_t size = wide ? sizeof(double) : sizeof(float);
        REQUIRE(result.out.size() == kRays * kBins * 3 * size);
        std::size_t counted = 0;
        for (std::size_t i = 0; i < kRays * kBins * 3; ++i) {
            const char* const at = result.out.data() + i * size;
            double value = 0;
            float narrow = 0;
            std::memcpy(wide ? static_cast<void*>(&value) : &narrow, at, size);
            if (!wide) value = static_cast<double>(narrow);
            const std::size_t ray = i / (3 * kBins), bin = i / 3 % kBins;
            if (value == (bin == ray ? 1 : 0)) ++counted;
        }
        CHECK(counted == kRays * kBins * 3);
    }
}
