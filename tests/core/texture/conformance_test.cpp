// What textures, patterns and mixtures see of a ray and do to it, held to Radiance's own values.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "io/picture/picture_data.h"
#include "tests/shared_data.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

struct ConformanceRow {
    std::string group, setup, probe, value;
};

std::vector<ConformanceRow> rows_of(const std::string& path, const std::string& group) {
    std::ifstream file(path);
    std::vector<ConformanceRow> rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        ConformanceRow row;
        std::getline(in, row.group, '\t');
        std::getline(in, row.setup, '\t');
        std::getline(in, row.probe, '\t');
        std::getline(in, row.value, '\t');
        if (row.group == group) rows.push_back(row);
    }
    return rows;
}

std::vector<double> numbers_of_row(const std::string& text) {
    std::istringstream in(text);
    std::vector<double> values;
    for (double x = 0; in >> x;) values.push_back(x);
    return values;
}

/// The words of xf "...", with their count for an argument list that has `before` words already.
std::string with_transform(const std::string& setup, int before, const std::string& words) {
    std::string transform;
    const std::size_t begin = setup.find("xf \"");
    if (begin != std::string::npos)
        transform = setup.substr(begin + 4, setup.find('"', begin + 4) - begin - 4);
    std::istringstream in(transform);
    int count = before;
    for (std::string word; in >> word;) ++count;
    return std::to_string(count) + " " + words + " " + transform;
}

const std::string kQuad = " polygon quad 0 0 12  -1 -1 0  1 -1 0  1 1 0  -1 1 0\n";

/// A value in three pieces that single-precision colours hold exactly.
constexpr const char* kPieces =
    "lifted = v + 16;  r1 = floor(lifted*262144)/262144;  rest = lifted - r1;"
    "r2 = floor(rest*4398046511104)/4398046511104;  r3 = rest - r2;";

double sum_of_pieces(const Rgb& pieces) {
    return static_cast<double>(pieces.r) - 16 + static_cast<double>(pieces.g) +
           static_cast<double>(pieces.b);
}

/// A glowing surface whose colour is the probed value, as the setup places it.
TestScene probe_scene(const ConformanceRow& row, const std::string& shape) {
    MemoryResources files;
    files.functions["tt.cal"] = "v = " + row.probe + ";" + kPieces;
    const std::string material = "void colorfunc probe " +
                                 with_transform(row.setup, 4, "r1 r2 r3 tt.cal") +
                                 " 0 0\nprobe glow g 0 0 4 1 1 1 0\n";
    if (row.setup.find("in instance A") == std::string::npos) {
        return TestScene(material + "g" + shape, TestScene::exact(), files);
    }
    Silence silence;
    const auto model = [&silence](const std::string& text) {
        return parse_scene(text, "model.rad", {LibraryPath(std::vector<std::string>{}), false},
                           silence);
    };
    files.octrees["a.oct"] = model(material + "g" + kQuad);
    files.octrees["b.oct"] = model("void instance A 7 a.oct -rz 90 -t .3 0 0 0 0\n");
    return TestScene("void instance B 4 b.oct -s 2 -mx 0 0\n", TestScene::exact(), files);
}

}  // namespace

TEST_CASE("function files see positions, directions and frames as Radiance's do") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    const std::vector<ConformanceRow> rows = rows_of(path, "shade");
    CHECK(rows.size() == 348);
    for (const ConformanceRow& row : rows) {
        CAPTURE(row.setup);
        CAPTURE(row.probe);
        const bool sphere = row.setup.starts_with("sphere"),
                   distant = row.setup.starts_with("distant");
        TestScene scene = probe_scene(row, sphere    ? " sphere s 0 0 4 0 0 0 1.5\n"
                                           : distant ? " source d 0 0 4 .1 -.2 -1 30\n"
                                                     : kQuad);
        const Vec3 origin = sphere ? Vec3{3, 2.5, 1.5} : Vec3{.25, .5, 3};
        const Vec3 direction = sphere ? Vec3{-2, -2, -1} : Vec3{.1, -.2, -1};
        const double expected = std::stod(row.value);
        const Rgb value = scene.trace(origin, direction).value;
        if (expected == kHuge) {  // too large for the pieces
            CHECK(static_cast<double>(value.r) == expected);
        } else {
            CHECK(std::abs(sum_of_pieces(value) - expected) <=
                  kRounding * std::max(1.0, std::abs(expected)));
        }
    }
}

TEST_CASE("texfunc perturbs normals as Radiance's does") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    const std::vector<ConformanceRow> rows = rows_of(path, "texfunc");
    CHECK(rows.size() == 11);
    for (const ConformanceRow& row : rows) {
        CAPTURE(row.setup);
        const std::size_t begin = row.setup.find("disp ") + 5;
        std::istringstream words(row.setup.substr(begin, row.setup.find(';', begin) - begin));
        std::string x, y, z;
        words >> x >> y >> z;
        MemoryResources files;
        files.functions["tt.cal"] = "dx = " + x + "; dy = " + y + "; dz = " + z + ";";
        TestScene scene("void texfunc bump " + with_transform(row.setup, 4, "dx dy dz tt.cal") +
                            " 0 0\nbump plastic p 0 0 5 .5 .5 .5 0 0\np" + kQuad,
                        TestScene::exact(), files);
        const bool slanted = row.setup.find("ray (-5") != std::string::npos;
        const Ray ray = slanted ? scene.trace({-5, .2, 1}, {1, 0, -.2})
                                : scene.trace({.25, .25, 5}, {0, 0, -1});
        const Vec3 normal =
            ray.perturbed() ? perturb_normal(ray).normal : ray.hit.normal + ray.hit.perturbation;
        const std::vector<double> expected = numbers_of_row(row.value);
        REQUIRE(expected.size() == 3);
        CHECK(length(normal - Vec3{expected[0], expected[1], expected[2]}) <= kRounding);
    }
}

TEST_CASE("mixfunc mixes materials, patterns and void as Radiance's does") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    const std::vector<ConformanceRow> rows = rows_of(path, "mixfunc");
    CHECK(rows.size() == 18);
    for (const ConformanceRow& row : rows) {
        CAPTURE(row.setup);
        CAPTURE(row.probe);
        const auto named = [&row](const std::string& what) {
            const std::size_t begin = row.setup.find(what + " ") + what.size() + 1;
            return row.setup.substr(begin, row.setup.find(';', begin) - begin);
        };
        MemoryResources files;
        const bool defines = row.setup.find("z=0") != std::string::npos;
        files.functions["tt.cal"] = std::string(defines ? "z=0; ee=1/z; " : "") +
                                    "half = .5; tenth = .1; " + row.probe + ";";
        const bool on_glow = row.setup.find("on glow") != std::string::npos;
        const auto trace = [&] {
            TestScene scene(
                "void glow red 0 0 4 1 0 0 0\nvoid glow blue 0 0 4 0 0 1 0\nvoid glow green 0 0 4 "
                "0 1 0 0\n"
                "void brightfunc p1 2 half tt.cal 0 0\nvoid brightfunc p2 2 tenth tt.cal 0 0\n" +
                    named("modifier") + " mixfunc mix 4 " + named("fore") + " " + named("back") +
                    " coef tt.cal 0 0\n" + (on_glow ? "mix glow g 0 0 4 1 1 1 0\ng" : "mix") +
                    kQuad + "green polygon behind 0 0 12 -9 -9 -5 9 -9 -5 9 9 -5 -9 9 -5\n",
                TestScene::exact(), files);
            return scene.trace({.25, .25, 5}, {0, 0, -1}).value;
        };
        if (row.value == "FATAL") {
            CHECK_THROWS_AS((void)trace(), InputError);
            continue;
        }
        const Rgb value = trace();
        const std::vector<double> expected = numbers_of_row(row.value);
        REQUIRE(expected.size() == 3);
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(static_cast<double>(value[k]) - expected[k]) <= kFloatRounding);
    }
}

TEST_CASE("colorpict passes its pixels through the colour functions") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 4\n";
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            for (const int byte : {10 * r + c + 1, 100, 50 + r, 136})
                bytes += static_cast<char>(byte);
        }
    }
    int tested = 0;
    for (const ConformanceRow& row : rows_of(path, "colorpict")) {
        if (row.setup.find("noop") != std::string::npos)
            continue;  // plain pictures: interpolate_test.cpp
        CAPTURE(row.setup);
        MemoryResources files;
        files.pictures["p.hdr"] =
            std::make_shared<const PictureData>(decode_picture(bytes, "p.hdr"));
        const std::size_t space = row.probe.find(' ');
        files.functions["tt.cal"] =
            row.probe.substr(0, space) + ";" + row.probe.substr(space) + ";";
        const std::string functions = row.setup.substr(row.setup.find("funcs ") + 6);
        TestScene scene("void colorpict p 7 " + functions +
                            " p.hdr tt.cal u v 0 0\np glow g 0 0 4 1 1 1 0\ng" + kQuad,
                        TestScene::exact(), files);
        const Rgb value = scene.trace({.25, .25, 5}, {0, 0, -1}).value;
        const std::vector<double> expected = numbers_of_row(row.value);
        REQUIRE(expected.size() == 3);
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(static_cast<double>(value[k]) - expected[k]) <=
                  kFloatRounding * std::max(1.0, expected[k]));
        ++tested;
    }
    CHECK(tested == 2);
}

}  // namespace lightwalk::test
