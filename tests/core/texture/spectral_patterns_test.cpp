// Patterns of spectra: the same spectrum, however it is given, is the same colour.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Of a lamp's light, at wavelengths from 400 to 750 nm in steps of 50.
const std::vector<float> kLamp{.1f, .3f, .5f, .7f, .9f, 1.f, .8f, .4f};
const std::string kFunctions = "keep(v, l) = v; half(v, l) = v/2; one(l) = 1; bad(l) = sqrt(-l);";

DataArray::Axis wavelengths() {
    return {400, 350, 8, {}};
}

MemoryResources files() {
    MemoryResources files;
    files.functions["f.cal"] = kFunctions;
    files.tables["lamp.dat"] = std::make_shared<const DataArray>(DataArray{{wavelengths()}, kLamp});
    DataArray ramp{{{0, 1, 2, {}}, wavelengths()}, std::vector<float>(8, 0.0f)};
    ramp.values.insert(ramp.values.end(), kLamp.begin(), kLamp.end());
    files.tables["ramp.dat"] = std::make_shared<const DataArray>(ramp);
    // A straight line at uneven wavelengths, and at even ones.
    files.tables["uneven.dat"] = std::make_shared<const DataArray>(
        DataArray{{{400, 350, 4, {400, 420, 650, 750}}}, {.1f, .12f, .35f, .45f}});
    files.tables["even.dat"] = std::make_shared<const DataArray>(
        DataArray{{{400, 350, 8, {}}}, {.1f, .15f, .2f, .25f, .3f, .35f, .4f, .45f}});
    SpectralPicture picture{
        {DataArray::Axis{0.5f, 0, 1, {}}, DataArray::Axis{0.5f, 0, 1, {}}}, 375, 775, 8, kLamp};
    files.spectral_pictures["lamp.hsr"] = std::make_shared<const SpectralPicture>(picture);
    return files;
}

/// What a pattern makes of white light.
Rgb color_of(const std::string& pattern, std::uint32_t sample = 0) {
    TestScene scene(pattern + "\npattern glow white 0 0 4 1 1 1 0\nwhite sphere s 0 0 4 0 5 0 1\n",
                    TestScene::exact(), files());
    return scene.trace({0, 0, 0}, {0, 1, 0}, sample).value;
}

void check_near(const Rgb& is, const Rgb& should, float tolerance = 1e-5f) {
    for (const float error : {is.r - should.r, is.g - should.g, is.b - should.b})
        CHECK(std::abs(error) <= tolerance);
}

const std::string kSpectrum = "void spectrum pattern 0 0 10 400 750 .1 .3 .5 .7 .9 1 .8 .4";

}  // namespace

TEST_CASE("spectral patterns: one spectrum is one colour, as numbers, tables or pictures") {
    const Rgb lamp = color_of(kSpectrum);
    CHECK(lamp.r > lamp.g);
    CHECK(lamp.g > lamp.b);
    check_near(color_of("void spectrum pattern 0 0 10 750 400 .4 .8 1 .9 .7 .5 .3 .1"), lamp, .01f);
    check_near(color_of("void specfile pattern 1 lamp.dat 0 0"), lamp);
    check_near(color_of("void specdata pattern 4 keep ramp.dat f.cal 1 0 0"), lamp);
    check_near(color_of("void specdata pattern 4 keep ramp.dat f.cal .5 0 0"), lamp * .5f);
    check_near(color_of("void specdata pattern 4 half ramp.dat f.cal 1 0 0"), lamp * .5f);
    check_near(color_of("void specpict pattern 5 keep lamp.hsr f.cal .5 .5 0 0"), lamp);
    check_near(color_of("void specpict pattern 5 half lamp.hsr f.cal .5 .5 0 0"), lamp * .5f);
    check_near(color_of("void specfile pattern 1 uneven.dat 0 0"),
               color_of("void specfile pattern 1 even.dat 0 0"), .01f);
}

TEST_CASE(
    "spectral patterns: the same at all wavelengths is grey, also where these are by chance") {
    for (std::uint32_t sample = 0; sample < 4; ++sample)
        check_near(color_of("void specfunc pattern 2 one f.cal 0 2 380 780", sample), {1, 1, 1},
                   .01f);
    const Rgb blue = color_of("void specfunc pattern 2 one f.cal 0 2 500 300");
    CHECK(blue.b > 2 * blue.r);
    CHECK(blue.b > 2 * blue.g);
}

TEST_CASE("spectral patterns: what cannot be evaluated changes no light") {
    check_near(color_of("void specfunc pattern 2 bad f.cal 0 2 380 780"), {1, 1, 1});
    check_near(color_of("void specdata pattern 4 keep ramp.dat f.cal bad(1) 0 0"), {1, 1, 1});
    check_near(color_of("void specpict pattern 5 keep lamp.hsr f.cal bad(1) .5 0 0"), {1, 1, 1});
}

TEST_CASE("spectral patterns: wrong wavelengths, tables and files are errors with their place") {
    for (const char* const wrong :
         {"void spectrum pattern 0 0 5 500 500 1 1 1", "void spectrum pattern 0 0 5 -1 500 1 1 1",
          "void spectrum pattern 0 0 4 400 700 1 1",
          "void specfunc pattern 2 one f.cal 0 2 800 900",
          "void specfunc pattern 2 one f.cal 0 1 400", "void specfile pattern 1 ramp.dat 0 0",
          "void specfile pattern 1 none.dat 0 0", "void specdata pattern 3 keep ramp.dat f.cal 0 0",
          "void specpict pattern 5 keep none.hsr f.cal .5 .5 0 0",
          "void specpict pattern 4 keep lamp.hsr f.cal .5 0 0"}) {
        CAPTURE(wrong);
        CHECK_THROWS_WITH_AS((void)color_of(wrong), doctest::Contains("test.rad"), InputError);
    }
}
