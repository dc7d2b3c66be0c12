// plasfunc, plasdata and relatives, BRTDfunc, plastic2 and ashik2: materials with expressions.
#include <doctest/doctest.h>

#include "core/material/lobes.h"
#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr double kOmega = kPi * 0.01;  // of the lamp below: radius 0.1, 1 away when projected

/// A floor of m at z = 0 under a lamp of radiance 100 and radius 0.2 at (0, 0, 2): omega is pi/100,
/// normal.
std::string lit_floor(const std::string& material) {
    return "void light l 0 0 3 100 100 100\nl sphere lamp 0 0 4 0 0 2 .2\n" + material +
           "m ring floor 0 0 8 0 0 0 0 0 1 0 5\n";
}

double floor_value(const std::string& material, MemoryResources files = {}) {
    TestScene scene(lit_floor(material), TestScene::exact(), std::move(files));
    return static_cast<double>(scene.trace({1, 0, 1}, {-1, 0, -1}).value.r);
}

}  // namespace

TEST_CASE("function lobes act on direct light, coloured for metal and transmission") {
    const double diffuse = 0.6 * 0.8 / kPi * 100 * kOmega;
    MemoryResources files;
    files.functions["lobe.cal"] = "lobe(x,y,z,om) = 2 + z + 0*om;\n";
    CHECK(relative_error(floor_value("void plasfunc m 2 lobe lobe.cal 0 4 .6 .6 .6 .2\n", files),
                         diffuse + 3 * 0.2 * 100 * kOmega) < kFloatRounding);
    CHECK(relative_error(floor_value("void metfunc m 2 lobe lobe.cal 0 4 .6 .6 .6 .2\n", files),
                         diffuse + 3 * 0.6 * 0.2 * 100 * kOmega) < kFloatRounding);
    // The lamp above a sheet that is seen from below.
    TestScene scene(lit_floor("void transfunc m 2 lobe lobe.cal 0 6 .6 .6 .6 .2 .5 .25\n"),
                    TestScene::exact(), files);
    const double value = static_cast<double>(scene.trace({1, 0, -1}, {-1, 0, 1}).value.r);
    CHECK(relative_error(value, (0.6 * 0.3 / kPi + 3 * 0.6 * 0.1) * 100 * kOmega) < kFloatRounding);
}

TEST_CASE("tabulated lobes pass the datum first, then the light") {
    MemoryResources files;
    files.functions["lobe.cal"] =
        "lobe(v,x,y,z,om) = v + 10*z;\nat(x,y,z,om) = 2*z + RdotP - RdotP;\n";
    auto table = std::make_shared<DataArray>();
    table->axes.push_back({0, 4, 3, {}});
    table->values = {5, 7, 1};
    files.tables["t.dat"] = table;
    const double diffuse = 0.6 * 0.8 / kPi * 100 * kOmega;
    CHECK(relative_error(
              floor_value("void plasdata m 4 lobe t.dat lobe.cal at 0 4 .6 .6 .6 .2\n", files),
              diffuse + 17 * 0.2 * 100 * kOmega) < kFloatRounding);
}

TEST_CASE("a table needs a coordinate for each dimension") {
    MemoryResources files;
    auto table = std::make_shared<DataArray>();
    table->axes.resize(2);
    for (auto& axis : table->axes) axis = {0, 1, 2, {}};
    table->values = {0, 0, 0, 0};
    files.tables["t.dat"] = table;
    CHECK_THROWS_WITH_AS(floor_value("void plasdata m 4 lobe t.dat . at 0 4 .6 .6 .6 .2\n", files),
                         "test.rad:3: bad number of string arguments for plasdata \"m\": at least "
                         "5 expected, 4 given",
                         InputError);
}

TEST_CASE("a lobe that cannot be computed leaves the diffuse part, and says so") {
    MemoryResources files;
    files.functions["lobe.cal"] = "lobe(x,y,z,om) = sqrt(-z);\n";
    TestScene scene(lit_floor("void plasfunc m 2 lobe lobe.cal 0 4 .6 .6 .6 .2\n"),
                    TestScene::exact(), files);
    CHECK(relative_error(scene.trace({1, 0, 1}, {-1, 0, -1}).value.r,
                         0.6 * 0.8 / kPi * 100 * kOmega) < kFloatRounding);
    CHECK(!scene.warnings.messages.empty());
}

TEST_CASE(
    "BRTDfunc: diffuse colours by side, mirror and straight parts, given functions of the light") {
    const std::string reals = " 0 9 .3 .3 .3 .05 .05 .05 .2 .2 .2\n";
    CHECK(relative_error(floor_value("void BRTDfunc m 10 0 0 0 0 0 0 0 0 0 ." + reals),
                         0.3 / kPi * 100 * kOmega) < kFloatRounding);
    MemoryResources files;
    files.functions["f.cal"] = "two(x,y,z,om) = 2*z*RdotP;\n";
    CHECK(relative_error(
              floor_value("void BRTDfunc m 10 0 0 0 0 0 0 two two two f.cal" + reals, files),
              (0.3 / kPi + 2 * std::sqrt(0.5)) * 100 * kOmega) < kFloatRounding);
    TestScene furnace(
        test::kFurnace +
        "void BRTDfunc m 10 RdotP RdotP RdotP .25 .25 .25 0 0 0 . 0 9 0 0 0 0 0 0 0 0 0\n" +
        test::sheet("s"));
    CHECK(relative_error(furnace.trace({0, 0, 1}, {0.6, 0, -0.8}).value.r, 0.8 + 0.25) <
          kFloatRounding);
    CHECK(relative_error(furnace.trace({0, 0, -1}, {0.6, 0, 0.8}).value.r, 0.8 + 0.25) <
          kFloatRounding);
}

TEST_CASE("plastic2 of equal slopes is plastic, and its brush turns with its direction") {
    const std::string rough =
        floor_value("void plastic m 0 0 5 .5 .5 .5 .3 .3\n") > 0 ? "ok" : "dark";
    REQUIRE(rough == "ok");
    CHECK(relative_error(floor_value("void plastic2 m 4 1 .3 0 . 0 6 .5 .5 .5 .3 .3 .3\n"),
                         floor_value("void plastic m 0 0 5 .5 .5 .5 .3 .3\n")) < kFloatRounding);
    const double along = floor_value("void plastic2 m 4 1 0 0 . 0 6 .5 .5 .5 .3 .5 .1\n");
    const double across = floor_value("void plastic2 m 4 0 1 0 . 0 6 .5 .5 .5 .3 .5 .1\n");
    CHECK(along > 1.2 * across);
    CHECK(relative_error(floor_value("void plastic2 m 6 0 1 0 . -rz -90 0 6 .5 .5 .5 .3 .5 .1\n"),
                         along) < kFloatRounding);
}

TEST_CASE("a brush along the normal is reported and replaced by its mean slope") {
    TestScene scene(lit_floor("void metal2 m 4 0 0 1 . 0 6 .5 .5 .5 .3 .1 .3\n"));
    const double value = static_cast<double>(scene.trace({1, 0, 1}, {-1, 0, -1}).value.r);
    REQUIRE(scene.warnings.messages.size() == 1);
    CHECK(scene.warnings.messages[0] ==
          "metal2 \"m\": illegal orientation vector: along the normal");
    const double mean = std::sqrt(0.05);
    CHECK(relative_error(
              value, floor_value("void metal2 m 4 1 0 0 . 0 6 .5 .5 .5 .3 " + std::to_string(mean) +
                                 " " + std::to_string(mean) + "\n")) < 1e-5);  // its six decimals
}

TEST_CASE("ashik2: base and lobe under one lamp") {
    const double s = std::sqrt(0.5), schlick = std::pow(1 - s, 5);
    const LobeFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double lobe = AshikhminReflection{{s, 0, s}, s, frame, 4, 9}.eval({0, 0, 1});
    const double specular = 0.1 + 0.9 * schlick;
    CHECK(relative_error(floor_value("void ashik2 m 4 1 0 0 . 0 8 .5 .5 .5 .1 .1 .1 4 9\n"),
                         (0.5 / kPi + specular * lobe) * 100 * kOmega) < kFloatRounding);
}
