#include "io/rays/ray_records.h"

#include <doctest/doctest.h>

#include <cstring>
#include <string>

#include "io/options/option_words.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using lightwalk::test::TestScene;
using test::float_rounded;

namespace {

const std::string kScene = R"(
void brightfunc half 2 .5 . 0 0
half plastic paint 0 0 5 .5 .5 .5 0 0
void light sun 0 0 3 9 9 9
paint polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
sun source star 0 0 4 0 0 1 2
)";

std::string record(const std::string& letters, const Vec3& origin, const Vec3& direction,
                   NumberFormat format = NumberFormat::text, ColorOutput color = ColorOutput::rgb) {
    TestScene scene(kScene);
    const Ray start = scene.tracer.primary(origin, direction, 0, RandomStream());
    const Hit first = scene.scene.geometry().intersect({start.origin, start.direction, kHuge});
    Ray ray = start;
    scene.tracer.shade_hit(ray, first, scene.context);
    std::string text;
    RayRecords(letters, format, color).append({ray, first}, scene.scene, text);
    return text;
}

std::string usage_error(const std::string& letters, NumberFormat format = NumberFormat::text,
                        ColorOutput color = ColorOutput::rgb) {
    try {
        const RayRecords records(letters, format, color);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

const Vec3 kAbove{1, 2, 3};
const Vec3 kDown{0, 0, -2};
const Vec3 kUp{0, 0, 1};
const Vec3 kAside{1, 0, 0};

}  // namespace

TEST_CASE("a hit: geometry and names, each field with a tab, each record with a line end") {
    CHECK(record("o", kAbove, kDown) == "1.000000e+00\t2.000000e+00\t3.000000e+00\t\n");
    CHECK(record("d", kAbove, kDown) == "0.000000e+00\t0.000000e+00\t-1.000000e+00\t\n");
    CHECK(record("p", kAbove, kDown) == "1.000000e+00\t2.000000e+00\t0.000000e+00\t\n");
    CHECK(record("N", kAbove, kDown) == "0.000000e+00\t0.000000e+00\t1.000000e+00\t\n");
    CHECK(record("lL", kAbove, kDown) == "3.000000e+00\t3.000000e+00\t\n");
    CHECK(record("smM~", kAbove, kDown) == "floor\tpaint\tpaint\t~\t\n");
    CHECK(record("wW", kAbove, kDown) ==
          "1.000000e+00\t1.000000e+00\t1.000000e+00\t1.000000e+00\t\n");
    CHECK(record("c", kAbove, kDown) == "0.000000e+00\t0.000000e+00\t\n");
}

TEST_CASE("a miss prints stars and zeros, lengths are 1e10") {
    CHECK(record("vnNsmM", {0, 0, 5}, kAside) ==
          "0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00\t0."
          "000000e+00\t"
          "0.000000e+00\t0.000000e+00\t*\t*\t*\t\n");
    CHECK(record("lLRX", {0, 0, 5}, kAside) ==
          "1.000000e+10\t1.000000e+10\t1.000000e+10\t1.000000e+10\t\n");
    CHECK(record("p", {0, 0, 5}, kAside) == "0.000000e+00\t0.000000e+00\t5.000000e+00\t\n");
}

TEST_CASE("a source at infinity: its names, its radiance, normals against the ray, length 1e10") {
    CHECK(record("vsmML", kAbove, kUp) ==
          "9.000000e+00\t9.000000e+00\t9.000000e+00\tstar\tsun\tsun\t1.000000e+10\t\n");
    CHECK(record("n", kAbove, kUp) == record("N", kAbove, kUp));
    CHECK(record("N", kAbove, kUp).ends_with("-1.000000e+00\t\n"));
}

TEST_CASE("colours can be one number or CIE XYZ, luminance is 179 times the brightness of grey") {
    CHECK(record("v", kAbove, kUp, NumberFormat::text, ColorOutput::mean) == "9.000000e+00\t\n");
    const auto luminance =
        std::stod(record("v", kAbove, kUp, NumberFormat::text, ColorOutput::luminance));
    CHECK(luminance == float_rounded(179 * 9));
    const std::string xyz = record("v", kAbove, kUp, NumberFormat::text, ColorOutput::xyz);
    for (const std::size_t at :
         {std::size_t{0}, xyz.find('\t') + 1, xyz.rfind('\t', xyz.size() - 3) + 1}) {
        CHECK(std::stod(xyz.substr(at)) == float_rounded(179 * 9));  // grey is equal-energy white
    }
}

TEST_CASE("binary records: numbers without separators, names with their tab") {
    const std::string bytes = record("Ls", kAbove, kDown, NumberFormat::real32);
    REQUIRE(bytes.size() == 4 + 6);
    float distance = 0;
    std::memcpy(&distance, bytes.data(), 4);
    CHECK(distance == 3);
    CHECK(bytes.substr(4) == "floor\t");
    CHECK(record("od", kAbove, kDown, NumberFormat::real64).size() == 48);
    CHECK(record("v", kAbove, kUp, NumberFormat::rgbe) == std::string("\x90\x90\x90\x84"));
}

TEST_CASE("what needs light, and how many numbers a record has") {
    CHECK_FALSE(RayRecords("odpcLNswmM~", NumberFormat::text, ColorOutput::rgb).shades());
    for (const std::string letters : {"v", "V", "W", "l", "n", "r", "x", "R", "X"}) {
        CHECK(RayRecords(letters, NumberFormat::text, ColorOutput::rgb).shades());
    }
    CHECK(RayRecords("odpnNvs~c", NumberFormat::text, ColorOutput::rgb).components() ==
          6 * 3 + 1 + 2);
    CHECK(RayRecords("v", NumberFormat::text, ColorOutput::luminance).components() == 1);
}

TEST_CASE("wrong output specifications are usage errors") {
    CHECK(usage_error("") == "option -o: empty output specification");
    CHECK(usage_error("vq").starts_with("option -o: unrecognized output option 'q'"));
    CHECK(usage_error("vn", NumberFormat::rgbe).starts_with("option -f: "));
    CHECK(usage_error("v", NumberFormat::rgbe, ColorOutput::mean).starts_with("option -f: "));
    CHECK(usage_error("r", NumberFormat::rgbe).empty());
}

TEST_CASE("the header ends with NCOMP and FORMAT, binary data start at a multiple of their size") {
    CHECK(RayRecords("v", NumberFormat::text, ColorOutput::rgb).header_end(5) ==
          "NCOMP=3\nFORMAT=ascii\n\n");
    CHECK(RayRecords("v", NumberFormat::text, ColorOutput::xyz).header_end(5) ==
          "NCOMP=3\nPRIMARIES= 1.0000 0.0000 0.0000 1.0000 0.0000 0.0000 0.3333 0.3333\n"
          "FORMAT=ascii\n\n");
    CHECK(RayRecords("v", NumberFormat::text, ColorOutput::rgb).header_end(5, false) ==
          "FORMAT=ascii\n\n");
    const RayRecords doubles("vL", NumberFormat::real64, ColorOutput::rgb);
    for (std::size_t before = 100; before < 110; ++before)
        CHECK((before + doubles.header_end(before).size()) % 8 == 0);
    CHECK(doubles.header_end(0).find("BigEndian=") != std::string::npos);
}
