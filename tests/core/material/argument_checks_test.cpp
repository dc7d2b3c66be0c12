#include "core/material/argument_checks.h"

#include "tests/core/material/surroundings.h"

#include <doctest/doctest.h>

using namespace lightwalk;
using test::TestScene;

namespace {

/// The error of a scene whose second line holds a material, used by a sphere.
std::string error_of(const std::string& material) {
    try {
        const TestScene scene("# materials\n" + material + "\nm sphere s 0 0 4 0 0 0 1\n");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string wrong_count(const std::string& material, const std::string& problem) {
    return "test.rad:2: bad number of " + material + " \"m\": " + problem;
}

}  // namespace

TEST_CASE("wrong numbers of real arguments are errors at the material's line") {
    CHECK(error_of("void plastic m 0 0 4 .5 .5 .5 0") ==
          wrong_count("arguments for plastic", "5 expected, 4 given"));
    CHECK(error_of("void metal m 0 0 6 1 1 1 1 0 0") ==
          wrong_count("arguments for metal", "5 expected, 6 given"));
    CHECK(error_of("void trans m 0 0 5 1 1 1 0 0") ==
          wrong_count("arguments for trans", "7 expected, 5 given"));
    CHECK(error_of("void plastic2 m 4 1 0 0 . 0 5 1 1 1 0 .1") ==
          wrong_count("arguments for plastic2", "6 expected, 5 given"));
    CHECK(error_of("void trans2 m 4 1 0 0 . 0 6 1 1 1 0 .1 .1") ==
          wrong_count("arguments for trans2", "8 expected, 6 given"));
    CHECK(error_of("void ashik2 m 4 1 0 0 . 0 0") ==
          wrong_count("arguments for ashik2", "8 expected, 0 given"));
    CHECK(error_of("void dielectric m 0 0 4 1 1 1 1.5") ==
          wrong_count("arguments for dielectric", "5 expected, 4 given"));
    CHECK(error_of("void interface m 0 0 5 1 1 1 1.5 0") ==
          wrong_count("arguments for interface", "8 expected, 5 given"));
    CHECK(error_of("void glass m 0 0 2 1 1") ==
          wrong_count("arguments for glass", "3 expected, 2 given"));
    CHECK(error_of("void glass m 0 0 5 1 1 1 1.5 0") ==
          wrong_count("arguments for glass", "4 expected, 5 given"));
    CHECK(error_of("void mirror m 0 0 2 1 1") ==
          wrong_count("arguments for mirror", "3 expected, 2 given"));
    CHECK(error_of("void mist m 0 0 8 1 1 1 1 1 1 0 0") ==
          wrong_count("arguments for mist", "7 expected, 8 given"));
    CHECK(error_of("void plasfunc m 2 f . 0 3 1 1 1") ==
          wrong_count("arguments for plasfunc", "at least 4 expected, 3 given"));
    CHECK(error_of("void transdata m 4 f d . c 0 5 1 1 1 0 0") ==
          wrong_count("arguments for transdata", "at least 6 expected, 5 given"));
    CHECK(error_of("void BRTDfunc m 10 0 0 0 0 0 0 0 0 0 . 0 3 1 1 1") ==
          wrong_count("arguments for BRTDfunc", "at least 9 expected, 3 given"));
}

TEST_CASE("missing string arguments are errors, too") {
    CHECK(error_of("void plastic2 m 3 1 0 0 0 6 1 1 1 0 .1 .1") ==
          wrong_count("string arguments for plastic2", "at least 4 expected, 3 given"));
    CHECK(error_of("void mirror m 2 a b 0 3 1 1 1") ==
          wrong_count("string arguments for mirror", "at most 1 expected, 2 given"));
    CHECK(error_of("void prism1 m 4 1 0 0 1 0 0") ==
          wrong_count("string arguments for prism1", "at least 5 expected, 4 given"));
    CHECK(error_of("void prism2 m 5 1 0 0 1 . 0 0") ==
          wrong_count("string arguments for prism2", "at least 9 expected, 5 given"));
    CHECK(error_of("void metfunc m 1 f 0 4 1 1 1 0") ==
          wrong_count("string arguments for metfunc", "at least 2 expected, 1 given"));
    CHECK(error_of("void plasdata m 3 f d . 0 4 1 1 1 0") ==
          wrong_count("string arguments for plasdata", "at least 4 expected, 3 given"));
    CHECK(error_of("void BRTDfunc m 9 0 0 0 0 0 0 0 0 0 0 9 1 1 1 1 1 1 1 1 1") ==
          wrong_count("string arguments for BRTDfunc", "at least 10 expected, 9 given"));
    CHECK(error_of("void antimatter m 0 0 0") ==
          wrong_count("string arguments for antimatter", "at least 1 expected, 0 given"));
}

TEST_CASE("arguments that mean nothing are refused") {
    CHECK(error_of("void dielectric m 0 0 5 1 1 1 0 0") ==
          "test.rad:2: dielectric \"m\": illegal index of refraction: it must be positive");
    CHECK(error_of("void interface m 0 0 8 1 1 1 1.5 1 1 1 0") ==
          "test.rad:2: interface \"m\": illegal index of refraction: it must be positive");
    CHECK(error_of("void glass m 0 0 4 1 1 1 -1.5") ==
          "test.rad:2: glass \"m\": illegal index of refraction: it must be positive");
    CHECK(error_of("void metal2 m 4 1 0 0 . 0 6 1 1 1 0 .1 0") ==
          "test.rad:2: metal2 \"m\": roughness too small: it must be above 1e-6 both ways");
}
