#pragma once
// Parts that the command lines and outputs of gensky and gendaylit have in common.
#include <optional>
#include <string>

#include "io/generators/generator_words.h"
#include "io/generators/solar.h"

namespace lightwalk {

/// The position of the sun, given as angles or as date and time.
struct SkyMoment {
    std::optional<SolarAngles> angles;  ///< from -ang
    SolarDate date;                     ///< used when there is no -ang
};

/// Consume "-ang altitude azimuth" if it is next.
[[nodiscard]] std::optional<SolarAngles> accept_angles(GeneratorWords& words);
/// Consume month and day.
[[nodiscard]] SolarDate take_date(GeneratorWords& words);
/// Consume the argument of -y, which must not be 0; warns for years in which the almanac is not
/// accurate.
[[nodiscard]] int take_year(GeneratorWords& words, WarningSink& warnings);
/// Consume an angle in degrees; returns radians.
[[nodiscard]] double take_degrees(GeneratorWords& words, const std::string& what);

/// Warn when the clock's meridian is more than 45 degrees from the site.
void check_meridian(const std::string& program, const Site& site, WarningSink& warnings);

/// The primitives "solar" and "sun"; `radiance` is written for all three channels, `angle` is the
/// full angle of the disk [deg].
[[nodiscard]] std::string sun_text(const std::string& radiance, const Vec3& direction,
                                   double angle);
/// A direction as "x y z" with six decimals.
[[nodiscard]] std::string direction_text(const Vec3& direction);
/// The comment lines of local solar time, altitude and azimuth.
[[nodiscard]] std::string time_comment(double hour);
[[nodiscard]] std::string angles_comment(const SolarAngles& angles);
/// One line of the output of -defaults.
[[nodiscard]] std::string default_line(const std::string& option, const std::string& meaning);

}  // namespace lightwalk
