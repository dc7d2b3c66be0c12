#include "io/generators/solar.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kDegree = kPi / 180;

/// x modulo p with the sign of p.
double modulo(double x, double p) {
    return x - p * std::floor(x / p);
}

SolarTime almanac_time(const SolarDate& date, const Site& site) {
    const int years = date.year - 1949;
    const bool leap = date.month > 2 && date.year % 4 == 0;
    // Days since noon, 1 January 2000, universal time.
    const double d = day_of_year(date.month, date.day) + (leap ? 1 : 0) + 365.0 * years +
                     std::floor(years / 4.0) + (date.hour + 12 * site.meridian / kPi) / 24 +
                     2432916.5 - 2451545;
    const double mean_longitude = modulo(280.460 + 0.9856474 * d, 360) * kDegree;
    const double anomaly = modulo(357.528 + 0.9856003 * d, 360) * kDegree;
    const double longitude =
        mean_longitude + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kDegree;
    const double obliquity = (23.439 - 4e-7 * d) * kDegree;
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
    if (date.solar_time) return {declination, date.hour};
    const double ascension =
        std::atan2(std::sin(longitude) * std::cos(obliquity), std::cos(longitude));
    const double universal = 24 * modulo(d, 1) + 12;
    const double hour_angle =
        6.697375 + 0.0657098242 * d + universal - 12 * (site.longitude + ascension) / kPi;
    return {declination, modulo(hour_angle + 12, 24)};
}

/// The polynomial c0 + c1 x + c2 x^2 + ...
double polynomial(const std::array<double, 5>& c, double x) {
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])));
}

double normalised_altitude(double altitude) {
    return (altitude - kPi / 4) / (kPi / 4);
}

}  // namespace

int day_of_year(int month, int day) {
    constexpr std::array<int, 12> kBefore = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    return kBefore[static_cast<std::size_t>(month - 1)] + day;
}

double simple_declination(int day_of_year) {
    return 0.4093 * std::sin(2 * kPi * (day_of_year - 81) / 365);
}

SolarTime solar_time(const SolarDate& date, const Site& site) {
    if (date.year != 0) return almanac_time(date, site);
    const int j = day_of_year(date.month, date.day);
    if (date.solar_time) return {simple_declination(j), date.hour};
    const double equation_of_time =
        0.170 * std::sin(4 * kPi * (j - 80) / 373) - 0.129 * std::sin(2 * kPi * (j - 8) / 355);
    return {simple_declination(j),
            date.hour + equation_of_time + 12 / kPi * (site.meridian - site.longitude)};
}

SolarAngles solar_angles(const SolarTime& time, const Site& site) {
    const double w = time.hour * kPi / 12;
    const double sin_lat = std::sin(site.latitude);
    const double cos_lat = std::cos(site.latitude);
    const double sin_dec = std::sin(time.declination);
    const double cos_dec = std::cos(time.declination);
    const double sine = sin_lat * sin_dec - cos_lat * cos_dec * std::cos(w);
    return {
        std::asin(std::clamp(sine, -1.0, 1.0)),
        -std::atan2(cos_dec * std::sin(w), -cos_lat * sin_dec - sin_lat * cos_dec * std::cos(w))};
}

Vec3 solar_direction(const SolarAngles& angles) {
    return {-std::sin(angles.azimuth) * std::cos(angles.altitude),
            -std::cos(angles.azimuth) * std::cos(angles.altitude), std::sin(angles.altitude)};
}

ZenithModel clear_sky_zenith(double altitude) {
    const double sine = std::sin(altitude);
    const double shape =
        0.274 * (0.91 + 10 * std::exp(-3 * (kPi / 2 - altitude)) + 0.45 * sine * sine);
    constexpr std::array<double, 5> kDiffuse = {2.766521, 0.547665, -0.369832, 0.009237, 0.059229};
    return {shape, polynomial(kDiffuse, normalised_altitude(altitude)) / (shape * kPi)};
}

ZenithModel intermediate_sky_zenith(double altitude) {
    const double shape = (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * altitude)) *
                         std::exp(-(kPi / 2 - altitude) * (0.4441 + 1.48 * altitude));
    constexpr std::array<double, 5> kDiffuse = {3.5556, -2.7152, -1.3081, 1.0660, 0.60227};
    return {shape, polynomial(kDiffuse, normalised_altitude(altitude)) / (shape * kPi)};
}

}  // namespace lightwalk
