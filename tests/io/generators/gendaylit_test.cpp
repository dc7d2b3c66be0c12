#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "io/generators/perez_sky.h"
#include "io/generators/solar.h"
#include "tests/io/generators/generated.h"
#include "tests/io/generators/library_file.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::float_rounded;
using test::generate;
using test::Generated;
using test::generator_error;
using test::near;
using test::printed;
using test::rounded;
using test::within;

/// The last primitive: the sky's pattern.
const PrimitiveText& sky_of(const Generated& generated) {
    REQUIRE(!generated.primitives.empty());
    return generated.primitives.back();
}

PerezDistribution distribution_of(const PrimitiveText& sky) {
    return {sky.reals.at(2), sky.reals.at(3), sky.reals.at(4), sky.reals.at(5), sky.reals.at(6)};
}

Vec3 sun_of(const PrimitiveText& sky) {
    return {sky.reals.at(7), sky.reals.at(8), sky.reals.at(9)};
}

/// What a sky of the printed numbers sheds on the ground.
double horizontal(const PrimitiveText& sky) {
    const double zenith = std::acos(sun_of(sky).z);
    return sky.reals.at(0) * distribution_of(sky).horizontal_integral(zenith);
}

/// The sky at `direction`, without what blends it into the ground.
double sky_radiance(const PrimitiveText& sky, const Vec3& direction) {
    const double gamma = std::acos(std::clamp(dot(direction, sun_of(sky)), -1.0, 1.0));
    const double zenith = std::acos(std::max(direction.z, 0.01));
    return sky.reals.at(0) * distribution_of(sky).luminance(zenith, gamma);
}

/// The direction's radiance as the function files blend it with the ground's.
double blended(const PrimitiveText& sky, const Vec3& direction) {
    const double w = std::pow(direction.z + 1.01, 10);
    return (w * sky_radiance(sky, direction) + sky.reals.at(1) / w) / (w + 1 / w);
}

const std::vector<Vec3> kDirections = {{0, 0, 1},          {0.6, 0, 0.8},   {0, -0.8, 0.6},
                                       {-0.48, 0.64, 0.6}, {0.8, 0.6, 0},   {0.36, 0.48, -0.8},
                                       {0, 0, -1},         {0.28, -0.96, 0}};

constexpr double kSunSolidAngle = 6.7967e-5;  // of a disk of 0.533 degrees [sr]

}  // namespace

TEST_CASE("gendaylit: the sky sheds the diffuse irradiance, the sun the direct one") {
    for (const char* weather : {"800 100", "300 200", "50 250", "0 120"}) {
        const auto day = generate(std::string("gendaylit -ang 40 -20 -O 1 -W ") + weather);
        double direct = 0;
        double diffuse = 0;
        std::sscanf(weather, "%lf %lf", &direct, &diffuse);
        REQUIRE(day.primitives.size() == 3);
        CHECK(test::names(day) == std::vector<std::string>{"solar", "sun", "skyfunc"});
        CHECK(day.primitives[0].type_word == "light");
        CHECK(day.primitives[1].modifier == "solar");
        CHECK(day.primitives[1].reals[3] == 0.533);
        CHECK(sky_of(day).type_word == "brightfunc");
        CHECK(sky_of(day).strings == std::vector<std::string>{"skybright", "perezlum.cal"});
        CHECK(sky_of(day).reals.size() == 10);
        CHECK(horizontal(sky_of(day)) == within(1e-3, diffuse));
        CHECK(day.primitives[0].reals[0] * kSunSolidAngle == within(1e-3, direct));
        const Vec3 sun = sun_of(sky_of(day));
        CHECK(near(sun, {test::vertex(day.primitives[1], 0)}));
        CHECK(near(sun, solar_direction({40 * kPi / 180, -20 * kPi / 180}), 1e-6));
    }
}

TEST_CASE("gendaylit: the model's 145 directions integrate the sky as a fine grid does") {
    const auto day = generate("gendaylit -ang 35 0 -O 1 -W 500 150");
    const PrimitiveText& sky = sky_of(day);
    double sum = 0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
        const double zenith = (i + 0.5) * kPi / 2 / kSteps;
        for (int j = 0; j < kSteps; ++j) {
            const double azimuth = (j + 0.5) * 2 * kPi / kSteps;
            const Vec3 direction{std::sin(zenith) * std::cos(azimuth),
                                 std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
            sum += sky_radiance(sky, direction) * std::cos(zenith) * std::sin(zenith);
        }
    }
    const double cell = kPi / 2 / kSteps * 2 * kPi / kSteps;
    CHECK(sum * cell == within(0.03, 150));
}

TEST_CASE("gendaylit: units of the output differ by the efficacies") {
    const std::string command = "gendaylit 5 17 11.5 -a 48 -o -11 -m -15 -W 600 120 -O ";
    const auto visible = generate(command + "0");
    const auto luminance = generate(command + "2");
    const auto solar = generate(command + "1");
    CHECK(sky_of(luminance).reals[0] / sky_of(visible).reals[0] == within(2e-3, 179));
    const double efficacy = sky_of(luminance).reals[0] / sky_of(solar).reals[0];
    CHECK(efficacy > 100);
    CHECK(efficacy < 160);
    CHECK(horizontal(sky_of(luminance)) == within(2e-3, 120 * efficacy));
}

TEST_CASE("gendaylit: the five kinds of weather describe the same sky") {
    const PerezSun sun{50 * kPi / 180, extraterrestrial_irradiance(0)};
    const DaylightPair weather{450, 180};
    const SkyCondition condition = sky_condition(weather, sun);
    const DaylightPair back = irradiances(condition, sun);
    CHECK(back.direct == rounded(450));
    CHECK(back.diffuse == rounded(180));
    const auto sky = [](const std::string& input) {
        return sky_of(generate("gendaylit -ang 40 10 -O 1 " + input)).reals;
    };
    const std::vector<double> expected = sky("-W 450 180");
    const auto check = [&](const std::vector<double>& reals) {
        REQUIRE(reals.size() == expected.size());
        for (std::size_t i = 0; i < reals.size(); ++i) {
            CHECK(reals[i] == within(2e-3, expected[i]));
        }
    };
    check(sky("-G " + std::to_string(450 * std::sin(40 * kPi / 180)) + " 180"));
    check(sky("-P " + std::to_string(condition.clearness) + " " +
              std::to_string(condition.brightness)));
    const double water = 2;
    const DaylightPair efficacy = luminous_efficacies(condition, sun, water);
    check(sky("-L " + std::to_string(450 * efficacy.direct) + " " +
              std::to_string(180 * efficacy.diffuse)));

    const auto global = generate("gendaylit -ang 40 10 -O 1 -E 500");
    const double direct = global.primitives[0].reals[0] * kSunSolidAngle;
    CHECK(direct * std::sin(40 * kPi / 180) + horizontal(sky_of(global)) == within(2e-3, 500));
    CHECK(global.text.find("# Direct normal irradiance: ") != std::string::npos);
}

TEST_CASE("gendaylit: classes of the sky's clearness, and the model's limits") {
    CHECK(clearness_class(1) == 0);
    CHECK(clearness_class(1.0649) == 0);
    CHECK(clearness_class(1.065) == 1);
    CHECK(clearness_class(4.5) == 6);
    CHECK(clearness_class(6.2) == 7);
    CHECK_FALSE(clearness_class(std::nan("")));
    const SkyCondition low = limited({0.5, 0});
    CHECK(low.clearness == 1);
    CHECK(low.brightness == 0.01);
    const SkyCondition high = limited({20, 2});
    CHECK(high.clearness == 12.009);
    CHECK(high.brightness == 0.6);
    // class 8: A = -1.05 + 0.0289 z + brightness (0.426 + 0.359 z)
    const auto clear = perez_distribution({7, 0.1}, 0.5);
    REQUIRE(clear);
    CHECK(clear->a == rounded(-1.05 + 0.0289 * 0.5 + 0.1 * (0.426 + 0.359 * 0.5)));
    CHECK(clear->d == rounded(-7.2312 + 0.405 * 0.5 + 0.1 * (13.35 + 0.6234 * 0.5)));
    // class 1: C = exp((brightness (2.8 + 0.6004 z))^1.2375) - 1
    const auto overcast = perez_distribution({1, 0.1}, 0.5);
    REQUIRE(overcast);
    CHECK(overcast->c == rounded(std::exp(std::pow(0.1 * (2.8 + 0.6004 * 0.5), 1.2375)) - 1));
    CHECK(overcast->d == rounded(-std::exp(0.1 * (1.8734 + 0.6297 * 0.5)) + 0.9738 + 0.1 * 0.2809));
    // hazy skies are at least 0.2 bright
    CHECK(perez_distribution({1.5, 0.1}, 0.5)->a == perez_distribution({1.5, 0.2}, 0.5)->a);
    CHECK(perez_distribution({2.9, 0.1}, 0.5)->a != perez_distribution({2.9, 0.2}, 0.5)->a);
}

TEST_CASE("gendaylit: an overcast sky has a black sun, -s none") {
    const auto overcast = generate("gendaylit -ang 30 0 -W 0 100");
    REQUIRE(overcast.primitives.size() == 3);
    CHECK(overcast.primitives[0].reals == std::vector<double>{0, 0, 0});
    CHECK(overcast.text.find("\n3 0.0 0.0 0.0\n") != std::string::npos);
    CHECK(test::names(generate("gendaylit -ang 30 0 -W 500 100 -s")) ==
          std::vector<std::string>{"skyfunc"});
    CHECK(generate("gendaylit -ang 30 0 -W 500 100 -s +s").primitives.size() == 3);
    const double with_sun = sky_of(generate("gendaylit -ang 30 0 -W 500 100")).reals[1];
    const double without = sky_of(generate("gendaylit -ang 30 0 -W 500 100 -s")).reals[1];
    CHECK(with_sun > 2 * without);
    CHECK(sky_of(generate("gendaylit -ang 30 0 -W 500 100 -g 0")).reals[1] == 0);
}

TEST_CASE("gendaylit: black skies say why") {
    const auto check_black = [](const std::string& command, const std::string& why) {
        CAPTURE(command);
        const auto black = generate(command);
        REQUIRE(black.primitives.size() == 1);
        for (std::size_t i = 0; i < 7; ++i) CHECK(sky_of(black).reals[i] == 0);
        CHECK(length(sun_of(sky_of(black))) == float_rounded(1));
        REQUIRE(!black.warnings.empty());
        CHECK(black.warnings.back().find(why) != std::string::npos);
        CHECK(generate(command + " -w").warnings.empty());
    };
    check_black("gendaylit 6 21 2 -W 100 100", "not up");
    check_black("gendaylit 6 21 12 -W 0 0", "neither");
    check_black("gendaylit 6 21 12 -W 1400 100", "above the atmosphere");
    check_black("gendaylit -ang -3 0 -G 100 100", "clearness");
    check_black("gendaylit 6 21 12 -W -5 -5", "neither");
    const auto polar_night = generate("gendaylit 12 21 12 -a 85 -o 0 -m 0 -W 0 100");
    CHECK(polar_night.primitives.size() == 3);
}

TEST_CASE("gendaylit: a measurement interval moves the hour into daylight") {
    // Solar time: at the equinox day 81 the sun rises at 6.
    CHECK(generate("gendaylit 3 22 +5.8 -W 10 50").primitives.size() == 1);
    const auto dawn = generate("gendaylit 3 22 +5.8 -W 10 50 -i 60");
    CHECK(dawn.primitives.size() == 3);
    CHECK(dawn.text.find("# Local solar time: 6.15\n") != std::string::npos);
    const auto dusk = generate("gendaylit 3 22 +18.2 -W 10 50 -i 60");
    CHECK(dusk.text.find("# Local solar time: 17.85\n") != std::string::npos);
    CHECK(generate("gendaylit 3 22 +12 -W 10 50 -i 60").text.find("# Local solar time: 12.00\n") !=
          std::string::npos);
}

TEST_CASE("gendaylit: the sun stays 3 degrees from the zenith, unless -c") {
    CHECK(sun_of(sky_of(generate("gendaylit -ang 89 0 -W 500 100"))).z ==
          float_rounded(std::sin(87 * kPi / 180)));
    CHECK(sun_of(sky_of(generate("gendaylit -ang 89 0 -W 500 100 -c"))).z ==
          float_rounded(std::sin(89 * kPi / 180)));
}

TEST_CASE("perezlum.cal: the printed sky, blended with the ground at the horizon") {
    const test::LibraryFile file = test::own_library_file("perezlum.cal");
    for (const char* weather : {"700 90", "100 200", "0 150"}) {
        const auto day = generate(std::string("gendaylit -ang 50 30 -W ") + weather);
        const PrimitiveText& sky = sky_of(day);
        for (const Vec3& direction : kDirections) {
            test::RayValues ray;
            ray.direction = direction;
            CHECK(file.value("skybright", sky.reals, ray) == rounded(blended(sky, direction)));
        }
    }
}

TEST_CASE("gendaylit -C and perezlum_c.cal: colors of overcast and clear skies") {
    const test::LibraryFile file = test::own_library_file("perezlum_c.cal");
    const std::vector<std::string> channels = {"skybright_r", "skybright_g", "skybright_b"};
    for (const char* command :
         {"gendaylit -ang 50 30 -W 0 150 -C", "gendaylit -ang 50 30 -W 850 80 -C -CIE"}) {
        const auto day = generate(command);
        const PrimitiveText& sky = sky_of(day);
        CHECK(sky.type_word == "colorfunc");
        CHECK(sky.strings == std::vector<std::string>{"skybright_r", "skybright_g", "skybright_b",
                                                      "perezlum_c.cal"});
        REQUIRE(sky.reals.size() == 22);
        for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0, -0.8, 0.6}}) {
            test::RayValues ray;
            ray.direction = direction;
            const std::vector<double> rgb = file.values(channels, sky.reals, ray);
            // Cramer's rule gives back Y from R, G, B
            const Vec3 x{2.5693, -1.0221, -0.0747};
            const Vec3 y{-1.1668, 1.9783, -0.2519};
            const Vec3 z{-0.3984, 0.0438, 1.1772};
            const Vec3 other = cross(z, x);
            const double luminance = dot(other, {rgb[0], rgb[1], rgb[2]}) / dot(other, y);
            CHECK(luminance == rounded(blended(sky, direction)));
        }
    }
    const auto overcast = generate("gendaylit -ang 50 30 -W 0 150 -C");
    test::RayValues zenith;
    zenith.direction = {0, 0, 1};
    const auto rgb = file.values(channels, sky_of(overcast).reals, zenith);
    CHECK(rgb[0] == within(0.2, rgb[2]));  // 6191 K is nearly white
    const auto blue = generate("gendaylit -ang 50 30 -W 850 80 -C");
    const auto clear = file.values(channels, sky_of(blue).reals, zenith);
    CHECK(clear[2] > 1.2 * clear[0]);

    const auto between = generate("gendaylit -ang 50 30 -W 300 200 -C");
    CHECK(sky_of(between).type_word == "brightfunc");
    REQUIRE(between.warnings.size() == 1);
    const auto own = generate("gendaylit -ang 50 30 -W 850 80 -C -l 1 2 3 4 5 6 7");
    const std::vector<double>& reals = sky_of(own).reals;
    CHECK(std::vector<double>(reals.begin() + 11, reals.end()) ==
          std::vector<double>{1, 2, 3, 4, 1, 2, 3, 4, 5, 6, 7});
    CHECK(sky_of(generate("gendaylit -ang 50 30 -W 850 80 -CIE")).type_word == "brightfunc");
}

TEST_CASE("gendaylit: mistakes") {
    CHECK(generator_error("gendaylit").find("usage: gendaylit") != std::string::npos);
    CHECK(generator_error("gendaylit 13 1 12") != "");
    CHECK(generator_error("gendaylit 6 32 12") != "");
    CHECK(generator_error("gendaylit 6 21 24").find("bad hour \"24\"") != std::string::npos);
    CHECK(generator_error("gendaylit 6 21 12:30") != "");
    CHECK(generator_error("gendaylit 6 21 12EST") != "");
    CHECK(generator_error("gendaylit 6 21 12 -i -5").find("interval") != std::string::npos);
    CHECK(generator_error("gendaylit 6 21 12 -O 3") != "");
    CHECK(generator_error("gendaylit 6 21 12 -W 5") != "");
    CHECK(generator_error("gendaylit 6 21 12 -q").find("unknown option \"-q\"") !=
          std::string::npos);
    CHECK(generator_error("gendaylit 6 21 12 -P 3 .2 -g 1e400") != "");
    CHECK(generator_error("gendaylit 6 21 12 -P 3 .2 -t 1 -b 2 -R 3") == "");
    test::Silence sink;
    CHECK(test::generate_text("gendaylit -defaults", {}, sink).find("-g 0.2") != std::string::npos);
}

}  // namespace lightwalk
