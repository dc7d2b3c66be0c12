#pragma once
// What gensky's and gendaylit's command lines and outputs have in common.
#include <optional>
#include <string>

#include "io/generators/generator_words.h"
#include "io/generators/solar.h"

namespace lightwalk {

/// When, or where the sun stands.
struct SkyMoment {
    std::optional<SolarAngles> angles;  ///< given with -ang
    SolarDate date;                     ///< otherwise
};

/// Take "-ang altitude azimuth" when it is next.
[[nodiscard]] std::optional<SolarAngles> accept_angles(GeneratorWords& words);
/// Take month and day.
[[nodiscard]] SolarDate take_date(GeneratorWords& words);
/// Take the argument of -y, which is not 0; warns where the almanac is not accurate.
[[nodiscard]] int take_year(GeneratorWords& words, WarningSink& warnings);
/// Take an angle in degrees; returns radians.
[[nodiscard]] double take_degrees(GeneratorWords& words, const std::string& what);

/// Warn when the clock's meridian is more than 45 degrees from the site.
void check_meridian(const std::string& program, const Site& site, WarningSink& warnings);

/// The primitives "solar" and "sun"; `radiance` is written three times, `angle` is the full one
/// [deg].
[[nodiscard]] std::string sun_text(const std::string& radiance, const Vec3& direction,
                                   double angle);
/// "x y z" with six decimals.
[[nodiscard]] std::string direction_text(const Vec3& direction);
/// The comment lines of local solar time, altitude and azimuth.
[[nodiscard]] std::string time_comment(double hour);
[[nodiscard]] std::string angles_comment(const SolarAngles& angles);
/// One line of what -defaults prints.
[[nodiscard]] std::string default_line(const std::string& option, const std::string& meaning);

}  // namespace lightwalk
