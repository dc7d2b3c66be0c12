#include "io/contributions/bin_definitions.h"

#include <doctest/doctest.h>

#include "tests/temporary_folder.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Rows of a sky of 10 degrees each, with half as many bins as degrees around at the horizon, and
/// fewer above: with a sum by recursion, as in Radiance's reinhart.cal.
const char* const kRows = R"({ bins of a sky }
DEGREE : PI/180;
row = floor(asin(Dz)/DEGREE/HIGH);
in_row(r) : if(r - (90/HIGH - 1.5), 1, 180 - r*20);
before(r) : if(r - .5, in_row(r-1) + before(r-1), 0);
azimuth = if(atan2(Dx,Dy), atan2(Dx,Dy), atan2(Dx,Dy) + 2*PI)/DEGREE;
bin = if(-Dz, -1, before(row) + floor(azimuth*in_row(row)/360));
COUNT : before(90/HIGH);
IN_FIRST : in_row(0)/HIGH;
)";

Vec3 towards(double altitude, double azimuth) {
    const double degree = kPi / 180, r = std::cos(altitude * degree);
    return {r * std::sin(azimuth * degree), r * std::cos(azimuth * degree),
            std::sin(altitude * degree)};
}

}  // namespace

TEST_CASE(
    "bins of a function file: recursion, constants that other definitions set, behind the rest") {
    const TemporaryFolder folder;
    const LibraryPath library({folder.path()});
    folder.write("rows.cal", kRows);
    BinDefinitions definitions;
    definitions.add_expression("HIGH : 10;");
    definitions.add_file("rows.cal", library);
    CHECK(definitions.count("COUNT", "") == 180 + 160 + 140 + 120 + 100 + 80 + 60 + 40 + 1);
    CHECK(definitions.count("IN_FIRST", "") == 18);
    const Program bin = definitions.bin("bin", "");
    BinChooser chooser;
    CHECK(chooser.choose(bin, towards(1, 1), {}) == 0);
    CHECK(chooser.choose(bin, towards(1, 359), {}) == 179);
    CHECK(chooser.choose(bin, towards(11, 1), {}) == 180);
    CHECK(chooser.choose(bin, towards(89, 200), {}) == 880);
    CHECK(!chooser.choose(bin, towards(-1, 10), {}));
}

TEST_CASE("a bin is the nearest integer, and none where that is negative") {
    const BinDefinitions definitions;
    const Program bin = definitions.bin("Px", "");
    BinChooser chooser;
    const auto at = [&](double x) { return chooser.choose(bin, {0, 0, 1}, {x, 0, 0}); };
    CHECK(at(-0.4) == 0);
    CHECK(!at(-0.6));
    CHECK(at(0.5) == 1);
    CHECK(at(2.4) == 2);
    CHECK(at(2.6) == 3);
    CHECK(!at(1e300));
}

TEST_CASE("parameters hold for one expression alone, over other definitions") {
    BinDefinitions definitions;
    definitions.add_expression("side = 1; twice(x) = 2*x");
    CHECK(definitions.count("side", "") == 1);
    CHECK(definitions.count("side + other", "side=3,other=max(1,2)") == 5);
    CHECK(definitions.count("twice(side)", "side=4") == 8);
    CHECK(definitions.count("side", "") == 1);
}
