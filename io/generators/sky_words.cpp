#include "io/generators/sky_words.h"

#include <cmath>

#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr long kLastYear = 9999;
constexpr double kMaxMeridianOffset = 45 * kPi / 180;

}  // namespace

std::optional<SolarAngles> accept_angles(GeneratorWords& words) {
    if (!words.accept("-ang")) return std::nullopt;
    const double altitude = take_degrees(words, "altitude");
    return SolarAngles{altitude, take_degrees(words, "azimuth")};
}

SolarDate take_date(GeneratorWords& words) {
    SolarDate date;
    date.month = static_cast<int>(words.integer("month", 1, 12));
    date.day = static_cast<int>(words.integer("day", 1, 31));
    return date;
}

int take_year(GeneratorWords& words, WarningSink& warnings) {
    const int year = static_cast<int>(words.integer("year", 1, kLastYear));
    if (year < 1950 || year > 2050) {
        warnings.warn(words.program() + ": year " + std::to_string(year) +
                      " is outside 1950 to 2050, the sun's position is not accurate");
    }
    return year;
}

double take_degrees(GeneratorWords& words, const std::string& what) {
    return words.real(what) * kPi / 180;
}

void check_meridian(const std::string& program, const Site& site, WarningSink& warnings) {
    if (std::abs(site.meridian - site.longitude) <= kMaxMeridianOffset) return;
    warnings.warn(program + ": the standard meridian is more than 45 degrees from the site, " +
                  "are both -o and -m given in degrees west?");
}

std::string sun_text(const std::string& radiance, const Vec3& direction, double angle) {
    return "\nvoid light solar\n0\n0\n3 " + radiance + " " + radiance + " " + radiance +
           "\n\nsolar source sun\n0\n0\n4 " + direction_text(direction) + " " + general(angle, 6) +
           "\n";
}

std::string direction_text(const Vec3& direction) {
    return fixed(direction.x, 6) + " " + fixed(direction.y, 6) + " " + fixed(direction.z, 6);
}

std::string time_comment(double hour) {
    return "# Local solar time: " + fixed(hour, 2) + "\n";
}

std::string angles_comment(const SolarAngles& angles) {
    return "# Solar altitude and azimuth: " + fixed(angles.altitude * 180 / kPi, 1) + " " +
           fixed(angles.azimuth * 180 / kPi, 1) + "\n";
}

std::string default_line(const std::string& option, const std::string& meaning) {
    return option + "\t# " + meaning + "\n";
}

}  // namespace lightwalk
