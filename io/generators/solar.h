#pragma once
// Where the sun stands, from date and time. Angles in radians, times in hours.
#include "core/math/vec3.h"

namespace lightwalk {

/// A place and its clock. The defaults are gensky's: San Francisco.
struct Site {
    double latitude = 0.66;             ///< north
    double longitude = 2.13;            ///< west
    double meridian = 120 * kPi / 180;  ///< standard meridian of the clock, west
};

struct SolarDate {
    int month = 1, day = 1;
    int year = 0;  ///< 0: the position is that of any year
    double hour = 0;
    bool solar_time = false;  ///< hour is local solar time, not the clock's
};

/// Declination and local solar time.
struct SolarTime {
    double declination = 0;
    double hour = 0;
};

/// Where the sun stands in the sky; azimuth is measured west of south.
struct SolarAngles {
    double altitude = 0;
    double azimuth = 0;
};

/// Day of the year from 1; February has 28 days.
[[nodiscard]] int day_of_year(int month, int day);

/// With a year: the almanac's position, good to 0.01 degrees from 1950 to 2050 (Michalsky, "The
/// Astronomical Almanac's algorithm for approximate solar position", Solar Energy 40 (1988), pp.
/// 227-235). Without: the formulas of IES, "Recommended practice for the calculation of daylight
/// availability", J. IES 13 (1984).
[[nodiscard]] SolarTime solar_time(const SolarDate& date, const Site& site);
[[nodiscard]] double simple_declination(int day_of_year);

[[nodiscard]] SolarAngles solar_angles(const SolarTime& time, const Site& site);

/// Unit vector toward the sun: x east, y north, z up.
[[nodiscard]] Vec3 solar_direction(const SolarAngles& angles);

/// Horizontal diffuse irradiance over pi times the zenith radiance: of the CIE's clear sky, and of
/// the intermediate sky. `altitude` is the sun's. Source: Radiance manual page gensky(1).
struct ZenithModel {
    double shape = 0;  ///< the relative luminance toward the zenith that the model is divided by
    double diffuse_factor = 0;
};
[[nodiscard]] ZenithModel clear_sky_zenith(double altitude);
[[nodiscard]] ZenithModel intermediate_sky_zenith(double altitude);
inline constexpr double kOvercastDiffuseFactor = 0.777778;

inline constexpr double kMaxSkyAltitude =
    87 * kPi / 180;  ///< beyond it the models do not hold [rad]

}  // namespace lightwalk
