#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "io/generators/solar.h"
#include "tests/io/generators/generated.h"
#include "tests/io/generators/library_file.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::generate;
using test::Generated;
using test::generator_error;
using test::printed;
using test::vertex;
using test::within;

constexpr double kDegree = kPi / 180;

/// The primitives of a sky by their role.
struct Sky {
    explicit Sky(const std::string& command) : generated(generate(command)) {
        for (const PrimitiveText& primitive : generated.primitives) {
            if (primitive.name == "solar") light = primitive;
            if (primitive.name == "sun") sun = primitive;
            if (primitive.name == "skyfunc") pattern = primitive;
        }
    }
    [[nodiscard]] bool has_sun() const { return light && sun; }
    [[nodiscard]] double model() const { return pattern.reals.at(0); }
    [[nodiscard]] double zenith() const { return pattern.reals.at(1); }
    [[nodiscard]] double ground() const { return pattern.reals.at(2); }
    [[nodiscard]] double shape() const { return pattern.reals.at(3); }

    Generated generated;
    std::optional<PrimitiveText> light, sun;
    PrimitiveText pattern;
};

/// The number that follows `label` in the comments.
std::string comment(const Sky& sky, const std::string& label) {
    const std::string text = "# " + label + ": ";
    const std::size_t at = sky.generated.text.find(text);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + text.size();
    return sky.generated.text.substr(begin, sky.generated.text.find('\n', begin) - begin);
}

/// Radiances are printed with four significant digits.
test::Near four_digits(double value) {
    return test::printed(4, value);
}

test::Near one_decimal(double value) {
    return {value, 0.05, 0.05};
}

/// Mean radiance that a horizontal surface sees: the integral of radiance times cosine over pi.
double horizontal_mean(const test::LibraryFile& library, const std::array<double, 7>& reals) {
    constexpr int kRings = 40;
    constexpr int kSectors = 30;
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double z = std::sqrt((i + 0.5) / kRings);  // rings of equal projected solid angle
        for (int j = 0; j < kSectors; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / kSectors;
            const double r = std::sqrt(1 - z * z);
            sum += library.value("skybr", reals,
                                 {.direction = {r * std::cos(phi), r * std::sin(phi), z}});
        }
    }
    return sum / (kRings * kSectors);
}

}  // namespace

TEST_CASE("gensky: what a ray of Radiance 6.1a saw of a summer noon over Jasper") {
    const Sky sky("gensky 7 12 12 -a 52.53 -o 118.05 -m 105 -g .2");
    CHECK(sky.generated.text.starts_with("# gensky 7 12 12 -a 52.53 -o 118.05 -m 105 -g .2\n"));
    const double seen =
        test::own_library_file("skybright.cal")
            .value("skybr", sky.pattern.reals, {.direction = {-0.7258622, -0.6450882, -0.2387161}});
    CHECK(seen == printed(8, 25.619156));  // 40.99065, eight digits too, through a glow of 1.6
    CHECK(comment(sky, "Local solar time") == "11.04");
    CHECK(comment(sky, "Solar altitude and azimuth") == "57.5 -25.4");
    CHECK(sky.generated.text.find("\n3 7.015e+06 7.015e+06 7.015e+06\n") != std::string::npos);
    CHECK(sky.generated.text.find("\n4 0.230129 -0.485404 0.843459 0.5\n") != std::string::npos);
    CHECK(sky.generated.text.find("\n7 1 1.395e+01 2.567e+01 8.370e-01 0.230129 ") !=
          std::string::npos);
}

TEST_CASE("gensky: what is written, for each model with and without sun") {
    struct Case {
        const char* option;
        double model;
        bool sun;
        std::size_t reals;
    };
    const std::array<Case, 9> cases = {{{"", 1, true, 7},
                                        {" +s", 1, true, 7},
                                        {" -s", 1, false, 7},
                                        {" -c", 2, false, 3},
                                        {" +c", 2, false, 3},
                                        {" -u", 3, false, 3},
                                        {" +u", 3, false, 3},
                                        {" +i", 4, true, 7},
                                        {" -i", 4, false, 7}}};
    for (const Case& c : cases) {
        CAPTURE(c.option);
        const Sky sky(std::string("gensky -ang 40 10") + c.option);
        CHECK(sky.pattern.type_word == "brightfunc");
        CHECK(sky.pattern.modifier == "void");
        CHECK(sky.pattern.strings == std::vector<std::string>{"skybr", "skybright.cal"});
        CHECK(sky.pattern.reals.size() == c.reals);
        CHECK(sky.model() == c.model);
        CHECK(sky.has_sun() == c.sun);
        if (!c.sun) continue;
        CHECK(sky.light->type_word == "light");
        CHECK(sky.sun->type_word == "source");
        CHECK(sky.sun->modifier == "solar");
        CHECK(sky.sun->reals.at(3) == 0.5);
        CHECK(sky.light->reals == std::vector<double>(3, sky.light->reals.at(0)));
        CHECK(vertex(*sky.sun, 0) ==
              Vec3{sky.pattern.reals[4], sky.pattern.reals[5], sky.pattern.reals[6]});
        const Vec3 expected = solar_direction({40 * kDegree, 10 * kDegree});
        CHECK(test::near(vertex(*sky.sun, 0), expected, 1e-6));
    }
    CHECK(generate("gensky -ang 40 10 -clouds").primitives.size() == 1);  // two characters count
    CHECK(Sky("gensky -ang 40 10 -i +s").model() == 1);                   // the last one wins
}

TEST_CASE("gensky: radiances of the clear sky") {
    for (const double altitude : {5., 35., 60., 80.}) {
        CAPTURE(altitude);
        const double h = altitude * kDegree;
        const double sz = std::sin(h);
        const Sky sky("gensky -ang " + std::to_string(altitude) + " -20 -g .3 -t 3");
        const double shape = 0.274 * (0.91 + 10 * std::exp(-3 * (kPi / 2 - h)) + 0.45 * sz * sz);
        const double x = (h - kPi / 4) / (kPi / 4);
        const double diffuse = 2.766521 + 0.547665 * x - 0.369832 * x * x +
                               0.009237 * std::pow(x, 3) + 0.059229 * std::pow(x, 4);
        const double zenith = ((1.376 * 3 - 1.81) * std::tan(h) + 0.38) * 1000 / 203;
        const double sun = 1.5e9 / 208 * (1.147 - 0.147 / (sz > 0.16 ? sz : 0.16));
        CHECK(sky.shape() == four_digits(shape));
        CHECK(sky.zenith() == four_digits(zenith));
        REQUIRE(sky.has_sun());
        CHECK(sky.light->reals[0] == four_digits(sun));
        const double ambient = zenith * diffuse / (shape * kPi);
        CHECK(sky.ground() == four_digits(0.3 * (ambient + 6e-5 / kPi * sun * sz)));
        CHECK(std::stod(comment(sky, "Ground ambient level")) == one_decimal(ambient));
        // Without the sun in view its light still reaches the ground.
        CHECK(Sky("gensky -ang " + std::to_string(altitude) + " -20 -g .3 -t 3 -s").ground() ==
              sky.ground());
    }
}

TEST_CASE("gensky: radiances of the other skies") {
    const double h = 50 * kDegree;
    const double sz = std::sin(h);
    const double overcast = (8.6 * sz + 0.123) * 1000 / 203;
    const double clear = ((1.376 * 2.45 - 1.81) * std::tan(h) + 0.38) * 1000 / 203;
    CHECK(Sky("gensky -ang 50 0 -c").zenith() == four_digits(overcast));
    CHECK(Sky("gensky -ang 50 0 -c").ground() == four_digits(0.2 * 0.777778 * overcast));
    CHECK(Sky("gensky -ang 50 0 -u").zenith() == four_digits(overcast));
    CHECK(Sky("gensky -ang 50 0 -u").ground() == four_digits(0.2 * overcast));
    const Sky mixed("gensky -ang 50 0 +i");
    CHECK(mixed.zenith() == four_digits((overcast + clear) / 2));
    CHECK(mixed.light->reals[0] == four_digits(0.15 * 1.5e9 / 208 * (1.147 - 0.147 / sz)));
    const double shape = (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * h)) *
                         std::exp(-(kPi / 2 - h) * (0.4441 + 1.48 * h));
    CHECK(mixed.shape() == four_digits(shape));
}

TEST_CASE("gensky -b, -B, -r, -R: given radiances and irradiances") {
    CHECK(Sky("gensky -ang 50 0 -b 12.5").zenith() == 12.5);
    CHECK(Sky("gensky -ang 50 0 -r 2e6").light->reals[0] == 2e6);
    // The printed irradiances are the given ones again.
    CHECK(std::stod(comment(Sky("gensky -ang 50 0 -B 300"), "Ground ambient level")) ==
          one_decimal(300 / kPi));
    CHECK(Sky("gensky -ang 50 0 -c -B 300").zenith() == four_digits(300 / (0.777778 * kPi)));
    CHECK(Sky("gensky -ang 50 0 -R 500").light->reals[0] ==
          four_digits(500 / (5.98e-5 * std::sin(50 * kDegree))));
    const Sky dark("gensky -ang 50 0 -R 0 -B 300");
    CHECK(!dark.has_sun());
    CHECK(dark.ground() == four_digits(0.2 * 300 / kPi));
}

TEST_CASE("gensky: at night there is no sun, and no negative radiance") {
    const Sky night("gensky -ang -20 0");
    CHECK(!night.has_sun());
    CHECK(night.zenith() == 0);
    CHECK(night.ground() == 0);
    CHECK(Sky("gensky -ang -20 0 -c").zenith() == 0);
}

TEST_CASE("gensky: clear and intermediate skies end at 87 degrees, with a warning") {
    for (const char* model : {"", " +i"}) {
        const Sky high(std::string("gensky -ang 89 0") + model);
        REQUIRE(high.generated.warnings.size() == 1);
        CHECK(high.generated.warnings[0].find("too close to the zenith") != std::string::npos);
        CHECK(high.generated.text.find("# warning: ") != std::string::npos);
        CHECK(high.sun->reals[2] == printed(6, std::sin(87 * kDegree)));
    }
    CHECK(Sky("gensky -ang 89 0 -c").generated.warnings.empty());
}

TEST_CASE("gensky: times, zones, and the site") {
    const auto hour = [](const std::string& time, const std::string& options = "") {
        return comment(Sky("gensky 6 21 " + time + " -a 40 -o 105 -m 105" + options),
                       "Local solar time");
    };
    CHECK(hour("+9.25") == "9.25");
    CHECK(hour("+14:45") == "14.75");
    CHECK(hour("9:30") == hour("9.5"));
    CHECK(hour("9.5MST") == hour("9.5"));
    CHECK(hour("10.5mdt") == hour("9.5"));
    CHECK(hour("9.5EST", " -m 10") == hour("7.5"));  // a zone overrides -m
    const auto at_zone = [&](const std::string& zone) { return std::stod(hour("12" + zone)); };
    const double greenwich = at_zone("GMT");
    // Two hours of two decimals each; the equation of time changes by 0.005 hours in half a day.
    const auto hours = [](double value) { return test::Near{value, 0.015, 0.015}; };
    CHECK(at_zone("YST") - greenwich == hours(9));
    CHECK(at_zone("NST") - greenwich == hours(3.5));
    CHECK(at_zone("CEST") - greenwich == hours(-2));
    CHECK(at_zone("IST") - greenwich == hours(-5.5));
    CHECK(at_zone("NZDT") - greenwich == hours(-13));
}

TEST_CASE("gensky: warnings of the site and the year") {
    CHECK(generate("gensky 6 21 12 -o 105 -m 50").warnings.size() == 1);
    CHECK(generate("gensky 6 21 12 -o 105 -m 61").warnings.empty());
    CHECK(generate("gensky 6 21 +12 -o 105 -m 50").warnings.empty());
    CHECK(generate("gensky 6 21 12 -y 1949").warnings.size() == 1);
    CHECK(generate("gensky 6 21 12 -y 2050").warnings.empty());
    CHECK(generate("gensky 6 21 12 -y 2050").text != generate("gensky 6 21 12").text);
}

TEST_CASE("gensky -defaults: the site and the atmosphere") {
    test::Silence sink;
    const std::string text = test::generate_text("gensky -defaults", {}, sink);
    for (const std::string line : {"-g 0.200000\t", "-t 2.450000\t", "-a 37.815214\t",
                                   "-o 122.040010\t", "-m 120.000000\t"}) {
        CAPTURE(line);
        CHECK(text.find(line) != std::string::npos);
    }
}

TEST_CASE("gensky: mistakes are told with the usage") {
    const std::string usage = "; usage: gensky month day time [options]";
    CHECK(
        generator_error("gensky 13 1 12")
            .starts_with("gensky: bad month \"13\", expected a whole number from 1 to 12" + usage));
    CHECK(generator_error("gensky 2 32 12").find("bad day \"32\"") != std::string::npos);
    CHECK(generator_error("gensky 2 3").find("missing time" + usage) != std::string::npos);
    CHECK(generator_error("gensky 2 3 noon").find("bad time \"noon\"") != std::string::npos);
    CHECK(generator_error("gensky 2 3 -1").find("bad time \"-1\"") != std::string::npos);
    CHECK(generator_error("gensky 2 3 12XYZ").find("expected a time zone that is known") !=
          std::string::npos);
    CHECK(generator_error("gensky 2 3 +12PST").find("no time zone after solar time") !=
          std::string::npos);
    CHECK(generator_error("gensky 2 3 12 -z").find("unknown option \"-z\"" + usage) !=
          std::string::npos);
    CHECK(generator_error("gensky 2 3 12 +b 3").find("unknown option \"+b\"") != std::string::npos);
    CHECK(generator_error("gensky 2 3 12 -g").find("missing ground reflectance") !=
          std::string::npos);
    CHECK(generator_error("gensky -ang 20").find("missing azimuth") != std::string::npos);
    CHECK(generator_error("gensky 2 3 12 -t 1e308").find("not finite") != std::string::npos);
}

TEST_CASE("skybright.cal: gensky's skies give the horizontal light that their ground is lit by") {
    const test::LibraryFile library = test::own_library_file("skybright.cal");
    for (const double altitude : {15., 40., 65.}) {
        for (const int model : {1, 2, 3, 4}) {
            CAPTURE(altitude);
            CAPTURE(model);
            const double h = altitude * kDegree;
            const Vec3 sun = solar_direction({h, 0.3});
            ZenithModel zenith{1, 1};
            if (model == 1) zenith = clear_sky_zenith(h);
            if (model == 2) zenith.diffuse_factor = kOvercastDiffuseFactor;
            if (model == 4) zenith = intermediate_sky_zenith(h);
            const std::array<double, 7> reals = {
                static_cast<double>(model), 1, 0, zenith.shape, sun.x, sun.y, sun.z};
            // The factors are fits, and the ground blends in at the horizon: up to 3 %.
            CHECK(horizontal_mean(library, reals) == within(0.03, zenith.diffuse_factor));
        }
    }
}

}  // namespace lightwalk
