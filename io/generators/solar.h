#pragma once
// The position of the sun, from date and time. Angles in radians, times in hours.
#include "core/math/vec3.h"

namespace lightwalk {

/// A place and its clock. The defaults are gensky's: San Francisco.
struct Site {
    double latitude = 0.66;             ///< positive to the north
    double longitude = 2.13;            ///< positive to the west
    double meridian = 120 * kPi / 180;  ///< standard meridian of the clock, west
};

struct SolarDate {
    int month = 1, day = 1;
    int year = 0;  ///< 0: formulas for an average year are used
    double hour = 0;
    bool solar_time = false;  ///< hour is local solar time, not the clock's
};

/// Declination and local solar time.
struct SolarTime {
    double declination = 0;
    double hour = 0;
};

/// The position of the sun in the sky; azimuth is 0 in the south and positive to the west.
struct SolarAngles {
    double altitude = 0;
    double azimuth = 0;
};

/// The day of the year, from 1; February has 28 days.
[[nodiscard]] int day_of_year(int month, int day);

/// Declination and local solar time of a date. With a year by the Astronomical Almanac, accurate to
/// 0.01 degrees from 1950 to 2050 (Michalsky, "The Astronomical Almanac's algorithm for approximate
/// solar position", Solar Energy 40 (1988), pp. 227-235). Without a year by the formulas of IES,
/// "Recommended practice for the calculation of daylight availability", J. IES 13 (1984).
[[nodiscard]] SolarTime solar_time(const SolarDate& date, const Site& site);
[[nodiscard]] double simple_declination(int day_of_year);

[[nodiscard]] SolarAngles solar_angles(const SolarTime& time, const Site& site);

/// The unit vector toward the sun; x is east, y north, z up.
[[nodiscard]] Vec3 solar_direction(const SolarAngles& angles);

/// The ratio of horizontal diffuse irradiance to pi times the zenith radiance, for the CIE's clear
/// and intermediate skies. `altitude` is that of the sun. Source: Radiance manual page gensky(1).
struct ZenithModel {
    double shape = 0;  ///< relative luminance at the zenith, by which the model is normalised
    double diffuse_factor = 0;  ///< the ratio
};
[[nodiscard]] ZenithModel clear_sky_zenith(double altitude);
[[nodiscard]] ZenithModel intermediate_sky_zenith(double altitude);
inline constexpr double kOvercastDiffuseFactor = 0.777778;

inline constexpr double kMaxSkyAltitude =
    87 * kPi / 180;  ///< the models are not valid for a higher sun [rad]

}  // namespace lightwalk
