#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "tests/io/bsdf/bsdf_text.h"
#include "tests/io/generators/generated.h"
#include "tests/temporary_folder.h"

namespace lightwalk {
namespace {

using test::generate;
using test::Generated;
using test::generator_error;
using test::near;
using test::vertex;

/// A file of a system of 1.2 by .8 m that is 2 cm thick, whose geometry begins in line 5.
std::string system_text(const std::string& geometry, const std::string& unit = "Meter") {
    std::string text = test::matrix_text("1 1 1 1 1 1 1 1 1");
    const std::string material = "<Name>three</Name>", definition = "</Material>";
    text.insert(text.find(material), "<Width>1.2</Width><Height>.8</Height>");
    if (!geometry.empty()) {
        text.insert(text.find(definition) + definition.size(),
                    "\n<Geometry format=\"MGF\"><MGFblock unit=\"" + unit + "\">" + geometry +
                        "</MGFblock></Geometry>");
    }
    return text;
}

/// What pkgBSDF makes of it.
Generated package(const std::string& geometry, const std::string& unit = "Meter") {
    const test::TemporaryFolder folder;
    folder.write("slats.xml", system_text(geometry, unit));
    return generate("pkgBSDF -s slats.xml", {folder.path(), {}});
}

std::string problem_in(const std::string& geometry) {
    const test::TemporaryFolder folder;
    folder.write("slats.xml", system_text(geometry));
    return generator_error("pkgBSDF -s slats.xml", {folder.path(), {}});
}

/// The first primitive of a type.
const PrimitiveText& first(const Generated& generated, const std::string& type) {
    const auto found = std::ranges::find(generated.primitives, type, &PrimitiveText::type_word);
    const bool is_there = found != generated.primitives.end();
    REQUIRE(is_there);
    return *found;
}

void check_reals(const PrimitiveText& primitive, const std::vector<double>& expected) {
    REQUIRE(primitive.reals.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(primitive.reals[i] == doctest::Approx(expected[i]).epsilon(1e-5));
}

const std::string kTriangle =
    "v a =\n p 0 0 -.01\nv b =\n p .1 0 -.01\nv c =\n p .1 .2 -.02\nf a b c\n";

}  // namespace

TEST_CASE("pkgBSDF: a system without geometry is one surface without thickness") {
    const Generated made = package("");
    REQUIRE(made.primitives.size() == 2);
    CHECK(made.primitives[0].strings ==
          std::vector<std::string>{"0", "slats.xml", "0", "1", "0", "."});
    CHECK(made.primitives[1].modifier == "m_slats");
    CHECK(near(vertex(made.primitives[1], 0), {-0.6, -0.4, 0}));
    CHECK(near(vertex(made.primitives[1], 2), {0.6, 0.4, 0}));
}

TEST_CASE("pkgBSDF: the surface of a system with geometry lies before it and is a little thicker") {
    const Generated made = package(kTriangle);
    REQUIRE(made.primitives.size() == 4);
    CHECK(made.primitives[0].name == "m_slats_f");
    CHECK(made.primitives[0].strings[0] == "0.020004");
    CHECK(vertex(made.primitives[1], 0).z == doctest::Approx(2e-6));
    CHECK(made.primitives[2].name == "mat");
    CHECK(near(vertex(made.primitives[3], 2), {0.1, 0.2, -0.02}));
    // Reflection from behind asks for a surface there.
    const test::TemporaryFolder folder;
    std::string text = system_text(kTriangle);
    const std::string from = "Transmission Back";
    folder.write("x y.xml", text.replace(text.find(from), from.size(), "Reflection Front"));
    const Generated both = generate("pkgBSDF -s 'x y.xml'", {folder.path(), {}});
    REQUIRE(both.primitives.size() == 6);
    CHECK(both.primitives[3].name == "x_y_b");
    CHECK(both.primitives[2].strings[0] == "-0.020004");
    CHECK(vertex(both.primitives[3], 0).z == doctest::Approx(2e-6 - 0.020004));
}

TEST_CASE("pkgBSDF: geometry is scaled by its unit, and transformed, also in arrays") {
    const Generated feet = package(kTriangle, "Foot");
    CHECK(near(vertex(feet.primitives[3], 2), {0.03048, 0.06096, -0.006096}));
    const Generated array = package(
        "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 0 1 0\n"
        "o slat\nxf -a 3 -t 0 0 -.5\nxf -s .1\nf a b c\nxf\nxf\n"
        "f a b c\n");
    std::vector<double> depths;
    for (const PrimitiveText& p : array.primitives) {
        if (p.type_word == "polygon" && p.name.find("slat.") != std::string::npos)
            depths.push_back(vertex(p, 1).x * 100 + vertex(p, 1).z);
    }
    const std::vector<double> expected{10, 9.5, 9, 100};
    REQUIRE(depths.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(depths[i] == doctest::Approx(expected[i]).epsilon(1e-9));
}

TEST_CASE("pkgBSDF: materials become what mgf2rad makes of them") {
    const auto material = [](const std::string& entities, const std::string& type) {
        const Generated made = package("m x =\n" + entities + "\n" + kTriangle);
        return first(made, type);
    };
    check_reals(material("rd .5\nrs .05 .1", "plastic"), {.526316, .526316, .526316, .05, .1});
    check_reals(material("rd .5\nrs .2 .1", "metal"), {.7, .7, .7, .285714, .1});
    check_reals(material("c\ncxy .4 .38\nrd .5\nrs .05 .1", "metal"),
                {.716535, .510264, .279545, .090909, .1});
    check_reals(material("c\ncxy .4 .38\nrd .3\nc\nrs .5 .1", "metal"),
                {.890837, .778326, .652479, .625, .1});
    check_reals(material("ir 1.52 0\nrs .08 0\nts .9 0", "glass"), {.98, .98, .98, 1.52});
    check_reals(material("rd .2\ntd .3\nrs .04 0", "trans"),
                {.520833, .520833, .520833, .04, 0, .6, 0});
    check_reals(material("rd .3\ned 100", "light"), {.177827, .177827, .177827});
    check_reals(material("c a =\ncxy .4 .4\nc b =\ncxy .3 .3\nc\ncmix 1 a 2 b\nrd .5", "plastic"),
                {.488932, .501217, .532700, 0, 0});
    const PrimitiveText tinted =
        material("c\ncxy .4 .38\nrd .2\ntd .3\nts .1 .05\nc\nrs .04 .2", "WGMDfunc");
    CHECK(tinted.strings[2] == "0.2");
    CHECK(tinted.strings[6] == "0.05");
    check_reals(material("c\ncspec 380 780 2 2 2 2\nrd .5", "plastic"), {.5, .5, .5, 0, 0});
}

TEST_CASE("pkgBSDF: every shape of the format") {
    const std::string shapes =
        "v a =\np 0 0 -.05\nn 0 0 1\nv b =\np 0 .1 -.05\nv c =\np .1 .1 -.05\nn 0 .1 1\n"
        "v d =\np .1 0 -.05\nn .1 0 1\nsph a .01\nsph a -.02\ncyl a .01 b\ncone a .02 b .01\n"
        "cone a -.02 b 0\ncyl a -.01 b\nring a .01 .02\nprism a d c b .03\ntorus a .005 .02\n"
        "f a d c\nfh a d c b - a b c\nzork 1\n";
    const Generated made = package(shapes);
    std::map<std::string, int> count;
    for (const PrimitiveText& p : made.primitives) ++count[p.type_word];
    CHECK(count["sphere"] == 1);
    CHECK(count["bubble"] == 1);
    CHECK(count["cylinder"] == 1);
    CHECK(count["tube"] == 1);
    CHECK(count["ring"] == 1);
    CHECK(count["cone"] + count["cup"] == 2 + 24);
    CHECK(count["texfunc"] == 1);          // a face with normals
    CHECK(count["polygon"] == 1 + 6 + 2);  // in front, the prism, faces
    REQUIRE(made.warnings.size() == 1);
    CHECK(made.warnings[0].find("slats.xml:27: MGF: \"zork\" is not known") != std::string::npos);
}

TEST_CASE("pkgBSDF: what is wrong is told where it stands") {
    CHECK(problem_in("v a =\nf a b c\n").find("slats.xml:6: undefined name \"b\"") !=
          std::string::npos);
    CHECK(problem_in("xf -t 0 0\nxf\n").find("slats.xml:5: ") != std::string::npos);
    CHECK(problem_in("\n\nxf file.rad\nxf\n").find("slats.xml:7: found \"file.rad\"") !=
          std::string::npos);
    CHECK(problem_in("m x =\n  rd \\\n  red\n").find("slats.xml:6: found \"red\", expected a") !=
          std::string::npos);
    CHECK(problem_in("xf\n").find("slats.xml:5: xf without") != std::string::npos);
    CHECK(problem_in("i other.mgf\n").find("other files are not included") != std::string::npos);
    std::string deep;
    for (int i = 0; i < 40; ++i) deep += "xf -a 100 -t 0 0 1\n";
    CHECK(problem_in(deep).find("nest too deep") != std::string::npos);
    CHECK(generator_error("pkgBSDF x.xml").find("expected -s") != std::string::npos);
    CHECK(generator_error("pkgBSDF -s nowhere.xml").find("nowhere.xml") != std::string::npos);
}

}  // namespace lightwalk
