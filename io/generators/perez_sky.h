#pragma once
// The all-weather sky luminance model of Perez, and its parameters from measured irradiances.
// Source: R. Perez, R. Seals, J. Michalsky, "All-weather model for sky luminance distribution",
// Solar Energy 50 (1993), pp. 235-245; efficacies: R. Perez, P. Ineichen, R. Seals, J. Michalsky,
// R. Stewart, "Modeling daylight availability and irradiance components from direct and global
// irradiance", Solar Energy 44 (1990), pp. 271-289. Angles in radians.
#include <array>
#include <cstddef>
#include <optional>

namespace lightwalk {

/// The weather: sky clearness and sky brightness of the model.
struct SkyCondition {
    double clearness = 1;
    double brightness = 0.01;
};

/// Direct normal and diffuse horizontal irradiance [W/m²] or illuminance [lx].
struct DaylightPair {
    double direct = 0, diffuse = 0;
};

/// The parameters of the sun in the model.
struct PerezSun {
    double zenith = 0;               ///< angle of the sun from the zenith, at most pi/2 [rad]
    double extraterrestrial = 1367;  ///< irradiance above the atmosphere, normal to the sun [W/m²]

    [[nodiscard]] double air_mass() const;
};

/// Extraterrestrial normal irradiance on a day of the year [W/m²].
[[nodiscard]] double extraterrestrial_irradiance(int day_of_year);

/// The sky condition of measured irradiances, limited to the range of the model; clearness may be
/// NaN.
[[nodiscard]] SkyCondition sky_condition(const DaylightPair& irradiance, const PerezSun& sun);
/// The irradiances of a sky condition: the inverse of sky_condition().
[[nodiscard]] DaylightPair irradiances(const SkyCondition& condition, const PerezSun& sun);
/// The condition limited to the range of the model: clearness 1 to 12.009, brightness 0.01 to 0.6.
[[nodiscard]] SkyCondition limited(SkyCondition condition);

/// The class of a clearness, 0 to 7; nothing for NaN.
[[nodiscard]] std::optional<std::size_t> clearness_class(double clearness);

/// Luminous efficacies of direct and diffuse light [lm/W]; `water` is the precipitable water of the
/// atmosphere [cm]. Zero for a clearness without class.
[[nodiscard]] DaylightPair luminous_efficacies(const SkyCondition& condition, const PerezSun& sun,
                                               double water);

/// The relative luminance distribution of the sky, by its coefficients A to E.
struct PerezDistribution {
    double a = 0, b = 0, c = 0, d = 0, e = 0;

    /// The relative luminance at angles `zenith` from the zenith and `gamma` from the sun [rad].
    [[nodiscard]] double luminance(double zenith, double gamma) const;
    /// The integral of luminance times cosine over the sky [sr], as a sum over the model's 145
    /// directions.
    [[nodiscard]] double horizontal_integral(double sun_zenith) const;
};

/// The distribution of a sky condition; nothing for a clearness without class.
[[nodiscard]] std::optional<PerezDistribution> perez_distribution(const SkyCondition& condition,
                                                                  double sun_zenith);

/// Split global horizontal irradiance into direct normal and diffuse horizontal irradiance. Source:
/// D. Erbs, S. Klein, J. Duffie, "Estimation of the diffuse radiation fraction for hourly, daily
/// and monthly-average global radiation", Solar Energy 28 (1982). `extraterrestrial` is the
/// horizontal extraterrestrial irradiance; `global` is limited to 0.999 of it [W/m²].
[[nodiscard]] DaylightPair split_global(double global, double extraterrestrial,
                                        double sin_altitude);

}  // namespace lightwalk
