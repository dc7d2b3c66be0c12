// gensky: the CIE's standard skies. See Radiance's manual page gensky(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "io/generators/generator.h"
#include "io/generators/scene_writer.h"
#include "io/generators/sky_command.h"
#include "io/generators/sky_words.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenskyUsage =
    "month day time [options] | -ang altitude azimuth [options] | -defaults";
constexpr double kSunDiameter = 0.5;  ///< [deg]
constexpr double kSkyEfficacy = 203;  ///< [lm/W]
constexpr double kSunEfficacy = 208;  ///< [lm/W]
constexpr double kSunDisc = 6e-5;     ///< [sr]

/// The numbers that skybright.cal knows the models by.
enum class SkyModel : std::uint8_t { clear = 1, overcast, uniform, intermediate };

/// A radiance that is given itself, or by the irradiance of a horizontal surface.
struct GivenRadiance {
    double value = 0;
    bool is_irradiance = false;
};

struct SkyOptions {
    SkyMoment moment;
    Site site;
    SkyModel model = SkyModel::clear;
    bool show_sun = true;
    double ground_reflectance = 0.2;
    double turbidity = 2.45;
    std::optional<GivenRadiance> zenith, sun;
    std::optional<double> zone;  ///< meridian of the time's zone [rad]

    [[nodiscard]] bool has_sun() const {
        return model == SkyModel::clear || model == SkyModel::intermediate;
    }
};

/// Standard meridian of a time zone, degrees west.
std::optional<double> zone_meridian(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, double>, 27> kZones = {
        {{"YST", 135},  {"YDT", 120},   {"PST", 120},  {"PDT", 105}, {"MST", 105},   {"MDT", 90},
         {"CST", 90},   {"CDT", 75},    {"EST", 75},   {"EDT", 60},  {"AST", 60},    {"ADT", 45},
         {"NST", 52.5}, {"NDT", 37.5},  {"GMT", 0},    {"BST", -15}, {"CET", -15},   {"CEST", -30},
         {"EET", -30},  {"EEST", -45},  {"GST", -60},  {"GDT", -75}, {"IST", -82.5}, {"IDT", -97.5},
         {"JST", -135}, {"NZST", -180}, {"NZDT", -195}}};
    const auto same = [](char a, char b) {
        return (a >= 'a' && a <= 'z' ? a - 'a' + 'A' : a) == b;
    };
    for (const auto& [zone, meridian] : kZones) {
        if (std::ranges::equal(name, zone, same)) return meridian;
    }
    return std::nullopt;
}

/// [+]H[.frac] or [+]H:MM, then a time zone.
void take_time(GeneratorWords& words, SkyOptions& sky) {
    const std::string& word = words.text("time");
    const auto bad = [&](const std::string& expected) {
        words.fail("bad time \"" + word + "\", expected " + expected);
    };
    std::string_view text = word;
    sky.moment.date.solar_time = text.starts_with('+');
    if (sky.moment.date.solar_time) text.remove_prefix(1);
    const auto take_digits = [&text] {
        double value = 0;
        std::size_t count = 0;
        for (; !text.empty() && text[0] >= '0' && text[0] <= '9'; text.remove_prefix(1), ++count) {
            value = 10 * value + (text[0] - '0');
        }
        return std::pair(value, count);
    };
    const auto [whole, whole_digits] = take_digits();
    std::size_t digits = whole_digits;
    double hour = whole;
    if (text.starts_with(':') || text.starts_with('.')) {
        const bool minutes = text[0] == ':';
        text.remove_prefix(1);
        const auto [part, part_digits] = take_digits();
        hour += minutes ? part / 60 : part / std::pow(10, static_cast<double>(part_digits));
        digits += part_digits;
    }
    if (digits == 0) bad("[+]hours or [+]hours:minutes");
    sky.moment.date.hour = hour;
    if (!std::isfinite(hour)) bad("fewer digits");
    if (text.empty()) return;
    if (sky.moment.date.solar_time) bad("no time zone after solar time");
    const std::optional<double> meridian = zone_meridian(text);
    if (!meridian) bad("a time zone that is known, like PST or CET");
    sky.zone = *meridian * kPi / 180;
}

/// The options that say which sky; false when it is another one.
bool take_model(char sign, char letter, SkyOptions& sky) {
    switch (letter) {
        case 's':
            sky.model = SkyModel::clear;
            break;
        case 'c':
            sky.model = SkyModel::overcast;
            break;
        case 'u':
            sky.model = SkyModel::uniform;
            break;
        case 'i':
            sky.model = SkyModel::intermediate;
            break;
        default:
            return false;
    }
    sky.show_sun = sign == '+';
    return true;
}

void take_option(GeneratorWords& words, SkyOptions& sky, WarningSink& warnings) {
    const std::string& word = words.peek();
    const char sign = word.empty() ? '\0' : word[0];
    const char letter = word.size() < 2 ? '\0' : word[1];
    if (sign != '-' && sign != '+') words.unknown_option();
    if (!take_model(sign, letter, sky)) {
        if (sign == '+' || std::string_view("ygtbBrRaom").find(letter) == std::string_view::npos) {
            words.unknown_option();
        }
    }
    static_cast<void>(words.text("option"));
    switch (letter) {
        case 'y':
            sky.moment.date.year = take_year(words, warnings);
            break;
        case 'g':
            sky.ground_reflectance = words.real("ground reflectance");
            break;
        case 't':
            sky.turbidity = words.real("turbidity");
            break;
        case 'b':
        case 'B':
            sky.zenith = {words.real("zenith radiance"), letter == 'B'};
            break;
        case 'r':
        case 'R':
            sky.sun = {words.real("solar radiance"), letter == 'R'};
            break;
        case 'a':
            sky.site.latitude = take_degrees(words, "latitude");
            break;
        case 'o':
            sky.site.longitude = take_degrees(words, "longitude");
            break;
        case 'm':
            sky.site.meridian = take_degrees(words, "standard meridian");
            break;
        default:
            break;
    }
}

SkyOptions parse_gensky(GeneratorWords& words, WarningSink& warnings) {
    SkyOptions sky;
    sky.moment.angles = accept_angles(words);
    if (!sky.moment.angles) {
        sky.moment.date = take_date(words);
        take_time(words, sky);
    }
    while (!words.at_end()) take_option(words, sky, warnings);
    if (sky.zone) sky.site.meridian = *sky.zone;
    if (!sky.moment.angles && !sky.moment.date.solar_time) {
        check_meridian(words.program(), sky.site, warnings);
    }
    return sky;
}

/// The option by which gensky knows a sky: one of kSkyTypes.
std::string type_of(const SkyOptions& sky) {
    if (sky.model == SkyModel::overcast) return "-c";
    if (sky.model == SkyModel::uniform) return "-u";
    const std::string sign = sky.show_sun ? "+" : "-";
    return sign + (sky.model == SkyModel::intermediate ? "i" : "s");
}

/// The values of a sky that are printed [W/(m² sr)].
struct SkyRadiances {
    double shape = 0;  ///< the model's value toward the zenith, F2
    double zenith = 0;
    double ground_ambient = 0;  ///< without the sun, not yet reflected
    double ground = 0;
    std::optional<double> sun;
};

ZenithModel zenith_model(const SkyOptions& sky, double altitude) {
    switch (sky.model) {
        case SkyModel::clear:
            return clear_sky_zenith(altitude);
        case SkyModel::overcast:
            return {0, kOvercastDiffuseFactor};
        case SkyModel::uniform:
            return {0, 1};
        default:
            return intermediate_sky_zenith(altitude);
    }
}

double zenith_radiance(const SkyOptions& sky, double altitude, double diffuse_factor) {
    if (sky.zenith) {
        return sky.zenith->is_irradiance ? sky.zenith->value / (diffuse_factor * kPi)
                                         : sky.zenith->value;
    }
    const double overcast = 8.6 * std::sin(altitude) + 0.123;  // [kcd/m²], as the next one
    const double clear = (1.376 * sky.turbidity - 1.81) * std::tan(altitude) + 0.38;
    double luminance = overcast;
    if (sky.model == SkyModel::clear) luminance = clear;
    if (sky.model == SkyModel::intermediate) luminance = (clear + overcast) / 2;
    return std::max(0.0, luminance) * 1000 / kSkyEfficacy;
}

std::optional<double> sun_radiance(const SkyOptions& sky, double altitude) {
    const double sine = std::sin(altitude);
    if (!sky.has_sun() || sine <= 0 || (sky.sun && sky.sun->value <= 0)) return std::nullopt;
    if (sky.sun) return sky.sun->is_irradiance ? sky.sun->value / (5.98e-5 * sine) : sky.sun->value;
    const double clear = 1.5e9 / kSunEfficacy * (1.147 - 0.147 / std::max(sine, 0.16));
    return sky.model == SkyModel::intermediate ? 0.15 * clear : clear;
}

SkyRadiances radiances(const SkyOptions& sky, double altitude) {
    const ZenithModel model = zenith_model(sky, altitude);
    SkyRadiances result;
    result.shape = model.shape;
    result.zenith = zenith_radiance(sky, altitude, model.diffuse_factor);
    result.ground_ambient = result.zenith * model.diffuse_factor;
    result.sun = sun_radiance(sky, altitude);
    const double from_sun = result.sun ? kSunDisc / kPi * *result.sun * std::sin(altitude) : 0;
    result.ground = sky.ground_reflectance * (result.ground_ambient + from_sun);
    if (!std::isfinite(result.shape + result.zenith + result.ground + result.sun.value_or(0))) {
        throw InputError("gensky: the radiances are not finite numbers");
    }
    return result;
}

std::string sky_text(const SkyOptions& sky, const SkyRadiances& L, const Vec3& sun) {
    std::string arguments = std::to_string(static_cast<int>(sky.model)) + " " +
                            scientific(L.zenith, 3) + " " + scientific(L.ground, 3);
    std::string count = "3 ";
    if (sky.has_sun()) {
        count = "7 ";
        arguments += " " + scientific(L.shape, 3) + " " + direction_text(sun);
    }
    return "\nvoid brightfunc skyfunc\n2 skybr skybright.cal\n0\n" + count + arguments + "\n";
}

std::string gensky_defaults() {
    const SkyOptions sky;
    return default_line("-g " + fixed(sky.ground_reflectance, 6), "ground reflectance") +
           default_line("-t " + fixed(sky.turbidity, 6), "atmospheric turbidity") +
           default_line("-a " + fixed(sky.site.latitude * 180 / kPi, 6),
                        "latitude, degrees north") +
           default_line("-o " + fixed(sky.site.longitude * 180 / kPi, 6),
                        "longitude, degrees west") +
           default_line("-m " + fixed(sky.site.meridian * 180 / kPi, 6),
                        "standard meridian, degrees west");
}

}  // namespace

SkyDetails gensky_details(std::span<const std::string> words) {
    GeneratorWords all(words, kGenskyUsage);
    NoWarnings quiet;
    const SkyOptions sky = parse_gensky(all, quiet);
    return {sky.moment, sky.site, type_of(sky)};
}

std::string run_gensky(std::span<const std::string> args, GeneratorContext& context) {
    if (args.size() == 2 && args[1] == "-defaults") return gensky_defaults();
    GeneratorWords words(args, kGenskyUsage);
    const SkyOptions sky = parse_gensky(words, context.warnings);
    std::string text = command_comment(args);
    SolarAngles angles;
    if (sky.moment.angles) {
        angles = *sky.moment.angles;
    } else {
        const SolarTime time = solar_time(sky.moment.date, sky.site);
        angles = solar_angles(time, sky.site);
        text += time_comment(time.hour) + angles_comment(angles);
    }
    if (sky.has_sun() && angles.altitude > kMaxSkyAltitude) {
        const std::string warning = "the sun is too close to the zenith, lowered to 87 degrees";
        context.warnings.warn(args[0] + ": " + warning);
        text += "# warning: " + warning + "\n";
        angles.altitude = kMaxSkyAltitude;
    }
    const SkyRadiances L = radiances(sky, angles.altitude);
    const Vec3 direction = solar_direction(angles);
    text += "# Ground ambient level: " + fixed(L.ground_ambient, 1) + "\n";
    if (L.sun && sky.show_sun) text += sun_text(scientific(*L.sun, 3), direction, kSunDiameter);
    return text + sky_text(sky, L, direction);
}

}  // namespace lightwalk
