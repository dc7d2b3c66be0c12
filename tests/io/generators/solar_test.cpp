#include "io/generators/solar.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::kRounding;
using test::rounded;
using test::within;

constexpr double kSolarDegree = kPi / 180;

Site site(double latitude, double longitude, double meridian) {
    return {latitude * kSolarDegree, longitude * kSolarDegree, meridian * kSolarDegree};
}

}  // namespace

TEST_CASE("day_of_year: February has 28 days") {
    CHECK(day_of_year(1, 1) == 1);
    CHECK(day_of_year(3, 1) == 60);
    CHECK(day_of_year(12, 31) == 365);
}

TEST_CASE("solar_angles: at noon the sun stands south at 90 - latitude + declination") {
    for (const double declination : {-23.45, 0., 12.}) {
        const SolarAngles noon = solar_angles({declination * kSolarDegree, 12}, site(47, 0, 0));
        CHECK(noon.altitude / kSolarDegree == rounded(43 + declination));
        CHECK(noon.azimuth == rounded(0));
        const Vec3 d = solar_direction(noon);
        CHECK(d.x == rounded(0));
        CHECK(d.y == rounded(-std::cos(noon.altitude)));
        CHECK(d.z == rounded(std::sin(noon.altitude)));
    }
}

TEST_CASE("solar_angles: at the equinox it rises due east at 6 and sets due west at 18") {
    for (const double latitude : {-30., 10., 60.}) {
        const SolarAngles rise = solar_angles({0, 6}, site(latitude, 0, 0));
        const SolarAngles set = solar_angles({0, 18}, site(latitude, 0, 0));
        CHECK(std::abs(rise.altitude) < kRounding);
        CHECK(std::abs(set.altitude) < kRounding);
        CHECK(rise.azimuth / kSolarDegree == rounded(-90));
        CHECK(set.azimuth / kSolarDegree == rounded(90));
        CHECK(solar_direction(rise).x == rounded(1));
        CHECK(solar_direction(set).x == rounded(-1));
    }
}

TEST_CASE("solar_time: four minutes a degree, and the equation of time within 17 minutes") {
    const SolarDate date{6, 21, 0, 9.5, false};
    const double at_meridian = solar_time(date, site(40, 105, 105)).hour;
    CHECK(solar_time(date, site(40, 120, 105)).hour == rounded(at_meridian - 1));
    CHECK(solar_time({6, 21, 0, 9.5, true}, site(40, 120, 105)).hour == 9.5);
    double largest = 0;
    double smallest = 0;
    for (int month = 1; month <= 12; ++month) {
        for (int day = 1; day <= 28; ++day) {
            const double e = solar_time({month, day, 0, 12, false}, site(40, 0, 0)).hour - 12;
            largest = std::max(largest, e * 60);
            smallest = std::min(smallest, e * 60);
        }
    }
    // The almanac's, in early November and mid February; the short formula is half a minute off.
    CHECK(std::abs(largest - 16.4) < 0.5);
    CHECK(std::abs(smallest - -14.3) < 0.5);
}

TEST_CASE("solar_time: declination of the solstices and equinoxes") {
    // 23.45 degrees is the amplitude: a day off the turn is 0.01 degrees less.
    CHECK(simple_declination(day_of_year(6, 21)) / kSolarDegree == within(0.001, 23.45));
    CHECK(simple_declination(day_of_year(12, 21)) / kSolarDegree == within(0.001, -23.45));
    // Near the equinox the declination changes by 0.4 degrees a day.
    CHECK(std::abs(simple_declination(day_of_year(3, 22)) / kSolarDegree) < 0.4);
    const Site greenwich = site(51.5, 0, 0);
    CHECK(solar_time({6, 21, 2010, 12, false}, greenwich).declination / kSolarDegree ==
          within(0.0005, 23.436));
    CHECK(std::abs(solar_time({3, 20, 2010, 17.5, false}, greenwich).declination / kSolarDegree) <
          0.02);  // 0.016 degrees an hour
}

TEST_CASE("solar_time with a year: the almanac's position of 17 October 2003 in Colorado") {
    // Worked example of Reda and Andreas, "Solar position algorithm for solar radiation
    // applications", NREL/TP-560-34302 (2003): 12:30:30, 7 hours west, zenith angle 50.11162,
    // azimuth 194.34024 degrees.
    const Site colorado = site(39.742476, 105.1786, 105);
    const SolarTime time = solar_time({10, 17, 2003, 12 + 30. / 60 + 30. / 3600, false}, colorado);
    const SolarAngles angles = solar_angles(time, colorado);
    CHECK(std::abs(angles.altitude / kSolarDegree - (90 - 50.11162)) < 0.03);  // refraction is 0.02
    CHECK(std::abs(angles.azimuth / kSolarDegree - 14.34024) < 0.02);
    // (Daily differences are alike to 2 %.) Leap years: the day after 28 February is the 29th, so
    // March begins a day later.
    const auto declination = [&](int year, int month, int day) {
        return solar_time({month, day, year, 12, false}, colorado).declination / kSolarDegree;
    };
    CHECK(declination(2004, 3, 1) - declination(2004, 2, 28) ==
          within(0.02, 2 * (declination(2004, 3, 2) - declination(2004, 3, 1))));
    CHECK(declination(2003, 3, 1) - declination(2003, 2, 28) ==
          within(0.02, declination(2003, 3, 2) - declination(2003, 3, 1)));
}

TEST_CASE("solar_time: without a year close to the almanac") {
    const Site colorado = site(39.742476, 105.1786, 105);
    for (const int month : {1, 4, 7, 10}) {
        CAPTURE(month);
        const SolarAngles simple =
            solar_angles(solar_time({month, 15, 0, 10, false}, colorado), colorado);
        const SolarAngles almanac =
            solar_angles(solar_time({month, 15, 2001, 10, false}, colorado), colorado);
        CHECK(length(solar_direction(simple) - solar_direction(almanac)) < 1.5 * kSolarDegree);
    }
}

TEST_CASE("zenith models: the clear sky's factor falls, the intermediate one's rises toward 1.2") {
    // Values at 45 degrees, where the polynomials' argument is 0.
    const double h = kPi / 4;
    const double clear = 0.274 * (0.91 + 10 * std::exp(-3 * h) + 0.45 * 0.5);
    CHECK(clear_sky_zenith(h).shape == rounded(clear));
    CHECK(clear_sky_zenith(h).diffuse_factor == rounded(2.766521 / (clear * kPi)));
    const double mixed =
        (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * h)) * std::exp(-h * (0.4441 + 1.48 * h));
    CHECK(intermediate_sky_zenith(h).shape == rounded(mixed));
    CHECK(intermediate_sky_zenith(h).diffuse_factor == rounded(3.5556 / (mixed * kPi)));
    // At the zenith (x = 1) and the horizon (x = -1).
    CHECK(clear_sky_zenith(kPi / 2).diffuse_factor * clear_sky_zenith(kPi / 2).shape * kPi ==
          rounded(2.766521 + 0.547665 - 0.369832 + 0.009237 + 0.059229));
    CHECK(intermediate_sky_zenith(0).diffuse_factor * intermediate_sky_zenith(0).shape * kPi ==
          rounded(3.5556 + 2.7152 - 1.3081 - 1.0660 + 0.60227));
}

}  // namespace lightwalk
