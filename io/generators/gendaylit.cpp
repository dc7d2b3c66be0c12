// gendaylit: a sky of Perez's model from weather data. See Radiance's manual page gendaylit(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/model/transform_args.h"
#include "io/generators/generator.h"
#include "io/generators/perez_sky.h"
#include "io/generators/scene_writer.h"
#include "io/generators/sky_command.h"
#include "io/generators/sky_words.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGendaylitUsage =
    "month day hour [-y year] | -ang altitude azimuth, "
    "[-P clearness brightness | -W direct diffuse | -G direct diffuse | -L direct diffuse | -E "
    "global] "
    "[options]";
constexpr double kLumensPerWatt = 179;            ///< Radiance's lumens per watt
constexpr double kMaxIrradiance = 1367;           ///< [W/m²]
constexpr double kMaxIlluminance = 127500;        ///< [lx]
constexpr double kSunAngle = 0.533;               ///< [deg]
constexpr double kSunSolidAngle = 6.8e-5;         ///< for its light on the ground [sr]
constexpr double kDefaultDewPoint = 10.97353115;  ///< [C]; 2 cm of water
constexpr double kMaxDewPoint = 40;
constexpr int kIlluminanceSteps = 9;

enum class WeatherInput : std::uint8_t { perez, normal, horizontal, illuminance, global };
enum class SkyUnits : std::uint8_t { visible_radiance, solar_radiance, luminance };

/// Chromaticities of daylight: x as a cubic of the reciprocal temperature, below and above 7000 K;
/// y as a quadratic of x.
using DaylightLocus = std::array<double, 11>;
constexpr DaylightLocus kDefaultLocus = {-4.843e9, 2.5568e6, 242.82,  0.23258, -4.843e9, 2.5568e6,
                                         242.82,   0.23258,  -1.2848, 1.7519,  -0.093786};
constexpr DaylightLocus kCieLocus = {-4.607e9, 2.9678e6, 99.11, 0.244063, -2.0064e9, 1.9018e6,
                                     247.48,   0.23704,  -3.0,  2.87,     -0.275};

struct DaylitOptions {
    SkyMoment moment;
    Site site;
    WeatherInput input = WeatherInput::perez;
    std::array<double, 2> values{};  ///< the two numbers after the option
    SkyUnits units = SkyUnits::visible_radiance;
    bool show_sun = true;
    bool limit_altitude = true;
    bool colored = false;
    bool quiet = false;
    double ground_reflectance = 0.2;
    double dew_point = kDefaultDewPoint;
    double interval = 0;  ///< interval of the measurement [min]
    DaylightLocus locus = kDefaultLocus;
};

/// Keeps warnings until it is known whether they are wanted.
class WarningList final : public WarningSink {
  public:
    void warn(const std::string& message) override { messages_.push_back(message); }
    void forward(WarningSink& sink) const {
        for (const std::string& message : messages_) sink.warn(message);
    }

  private:
    std::vector<std::string> messages_;
};

void take_hour(GeneratorWords& words, SolarDate& date) {
    const std::string& word = words.text("hour");
    date.solar_time = word.starts_with('+');
    const std::string_view number = std::string_view(word).substr(date.solar_time ? 1 : 0);
    if (!parse_real(number, date.hour) || !(date.hour >= 0 && date.hour < 24)) {
        words.fail("bad hour \"" + word + "\", expected a number from 0 to 24");
    }
}

/// Take what says how the weather is given.
bool accept_input(GeneratorWords& words, DaylitOptions& sky) {
    struct Input {
        std::string_view option;
        WeatherInput input;
        std::array<const char*, 2> values;
    };
    constexpr std::array<Input, 5> kInputs = {{
        {"-P", WeatherInput::perez, {"clearness", "brightness"}},
        {"-W", WeatherInput::normal, {"direct normal irradiance", "diffuse irradiance"}},
        {"-G", WeatherInput::horizontal, {"direct horizontal irradiance", "diffuse irradiance"}},
        {"-L", WeatherInput::illuminance, {"direct normal illuminance", "diffuse illuminance"}},
        {"-E", WeatherInput::global, {"global horizontal irradiance", nullptr}},
    }};
    for (const Input& known : kInputs) {
        if (!words.accept(known.option)) continue;
        sky.input = known.input;
        for (std::size_t i = 0; i < 2; ++i) {
            if (known.values[i] != nullptr) sky.values[i] = words.real(known.values[i]);
        }
        return true;
    }
    return false;
}

/// Take an option without arguments.
bool accept_switch(GeneratorWords& words, DaylitOptions& sky) {
    if (words.accept("-s"))
        sky.show_sun = false;
    else if (words.accept("+s"))
        sky.show_sun = true;
    else if (words.accept("-c") || words.accept("+c"))
        sky.show_sun = sky.limit_altitude = false;
    else if (words.accept("-w"))
        sky.quiet = true;
    else if (words.accept("-C"))
        sky.colored = true;
    else if (words.accept("-CIE"))
        sky.locus = kCieLocus;
    else
        return false;
    return true;
}

void take_locus(GeneratorWords& words, DaylightLocus& locus) {
    for (std::size_t i = 0; i < 4; ++i) locus[i] = locus[4 + i] = words.real("coefficient");
    for (std::size_t i = 8; i < 11; ++i) locus[i] = words.real("coefficient");
}

void take_option(GeneratorWords& words, DaylitOptions& sky, WarningSink& warnings) {
    if (accept_input(words, sky) || accept_switch(words, sky)) return;
    if (words.accept("-y")) {
        sky.moment.date.year = take_year(words, warnings);
    } else if (words.accept("-O")) {
        sky.units = static_cast<SkyUnits>(words.integer("kind of output", 0, 2));
    } else if (words.accept("-g")) {
        sky.ground_reflectance = words.real("ground reflectance");
    } else if (words.accept("-a")) {
        sky.site.latitude = take_degrees(words, "latitude");
    } else if (words.accept("-o")) {
        sky.site.longitude = take_degrees(words, "longitude");
    } else if (words.accept("-m")) {
        sky.site.meridian = take_degrees(words, "standard meridian");
    } else if (words.accept("-d")) {
        const double dew_point = words.real("dew point");
        sky.dew_point = std::abs(dew_point) > kMaxDewPoint ? kDefaultDewPoint : dew_point;
    } else if (words.accept("-i")) {
        sky.interval = words.real("interval");
        if (sky.interval < 0) words.fail("the measurement interval is negative");
    } else if (words.accept("-l")) {
        take_locus(words, sky.locus);
    } else if (words.accept("-t") || words.accept("-b") || words.accept("-R")) {
        static_cast<void>(words.real("number"));  // options of gensky, without effect
    } else {
        words.unknown_option();
    }
}

DaylitOptions parse_gendaylit(GeneratorWords& words, WarningSink& warnings) {
    DaylitOptions sky;
    sky.moment.angles = accept_angles(words);
    if (!sky.moment.angles) {
        sky.moment.date = take_date(words);
        take_hour(words, sky.moment.date);
    }
    while (!words.at_end()) take_option(words, sky, warnings);
    if (!sky.moment.angles && !sky.moment.date.solar_time) {
        check_meridian(words.program(), sky.site, warnings);
    }
    return sky;
}

/// Move the hour into the middle of that part of the interval that has sun. False when the sun is
/// not up.
bool adjust_to_daylight(const DaylitOptions& sky, double& hour) {
    const double declination =
        simple_declination(day_of_year(sky.moment.date.month, sky.moment.date.day));
    const double half_day =
        12 / kPi * std::acos(-std::tan(sky.site.latitude) * std::tan(declination));
    if (std::isnan(half_day)) return true;  // near the poles no sunrise is found
    const double sunrise = 12 - half_day;
    const double sunset = 12 + half_day;
    const double half_interval = sky.interval / 120;
    if (std::abs(sunrise - hour) <= half_interval) hour = (hour + half_interval + sunrise) / 2;
    if (std::abs(sunset - hour) < half_interval) hour = (hour - half_interval + sunset) / 2;
    return hour >= sunrise - half_interval && hour <= sunset + half_interval;
}

/// The weather as parameters of the model. `fault` is the reason when there is no sky.
struct Weather {
    SkyCondition condition;
    PerezDistribution distribution;
    DaylightPair irradiance, illuminance;
    std::string fault;
};

/// The irradiances that make these illuminances, by repeated use of the efficacies.
DaylightPair irradiances_of(const DaylightPair& illuminance, const PerezSun& sun, double water) {
    constexpr double kLeastEfficacy = 0.1;
    DaylightPair result = {illuminance.direct * kMaxIrradiance / kMaxIlluminance,
                           illuminance.diffuse * kMaxIrradiance / kMaxIlluminance};
    for (int i = 0; i < kIlluminanceSteps; ++i) {
        const DaylightPair efficacy = luminous_efficacies(sky_condition(result, sun), sun, water);
        result.diffuse = illuminance.diffuse / efficacy.diffuse;
        result.direct = efficacy.direct < kLeastEfficacy ? 0 : illuminance.direct / efficacy.direct;
    }
    return result;
}

/// The two values of the input but -P as direct normal and diffuse horizontal ones.
DaylightPair given_pair(const DaylitOptions& sky, double altitude, const PerezSun& sun,
                        const std::string& program, WarningSink& warnings) {
    DaylightPair given = {sky.values[0], sky.values[1]};
    if (given.direct < 0 || given.diffuse < 0) {
        warnings.warn(program + ": negative irradiance, 0 taken instead");
        given = {std::max(0.0, given.direct), std::max(0.0, given.diffuse)};
    }
    const bool horizontal =
        sky.input == WeatherInput::horizontal || sky.input == WeatherInput::global;
    if (!horizontal) return given;
    if (altitude <= 0) return {};
    const double sine = std::sin(altitude);
    if (sky.input == WeatherInput::horizontal) return {given.direct / sine, given.diffuse};
    return split_global(given.direct, sun.extraterrestrial * sine, sine);
}

Weather weather_of(const DaylitOptions& sky, double altitude, const PerezSun& sun,
                   const std::string& program, WarningSink& warnings) {
    const double water = std::exp(0.07 * sky.dew_point - 0.075);
    Weather result;
    if (sky.input == WeatherInput::perez) {
        result.condition = limited({sky.values[0], sky.values[1]});
        result.irradiance = irradiances(result.condition, sun);
    } else {
        const DaylightPair given = given_pair(sky, altitude, sun, program, warnings);
        if (given.direct == 0 && given.diffuse == 0 && altitude > 0) {
            result.fault = "neither direct nor diffuse light";
            return result;
        }
        const bool lux = sky.input == WeatherInput::illuminance;
        result.irradiance = lux ? irradiances_of(given, sun, water) : given;
        result.condition = sky_condition(result.irradiance, sun);
        result.illuminance = given;
    }
    if (sky.input != WeatherInput::illuminance) {
        const DaylightPair efficacy = luminous_efficacies(result.condition, sun, water);
        result.illuminance = {result.irradiance.direct * efficacy.direct,
                              result.irradiance.diffuse * efficacy.diffuse};
    }
    const bool uses_illuminance =
        sky.input == WeatherInput::illuminance || sky.units != SkyUnits::solar_radiance;
    const std::optional<PerezDistribution> distribution =
        perez_distribution(result.condition, sun.zenith);
    if (result.irradiance.direct > kMaxIrradiance ||
        (uses_illuminance && result.illuminance.direct > kMaxIlluminance)) {
        result.fault = "more direct light than above the atmosphere";
    } else if (!distribution) {
        result.fault = "the irradiances determine no sky clearness";
    } else if (distribution->b > 0) {
        result.fault = "the sky condition is outside the model, coefficient b is positive";
    } else {
        result.distribution = *distribution;
    }
    return result;
}

/// The values of a sky that are printed, in the units of the -O option.
struct SkyOutput {
    double scale = 0;  ///< factor of the relative luminance
    double ground = 0;
    double sun = 0;
};

SkyOutput sky_output(const DaylitOptions& sky, const Weather& weather, const SolarAngles& angles,
                     double sun_zenith) {
    const double integral = weather.distribution.horizontal_integral(sun_zenith);
    const double solid_angle = 2 * kPi * (1 - std::cos(kSunAngle / 2 * kPi / 180));
    DaylightPair light = weather.illuminance;
    if (sky.units == SkyUnits::solar_radiance) light = weather.irradiance;
    const double efficacy = sky.units == SkyUnits::visible_radiance ? kLumensPerWatt : 1;
    SkyOutput result;
    result.scale = light.diffuse / (efficacy * integral);
    result.sun = light.direct / (efficacy * solid_angle);
    const double clearness = weather.condition.clearness;
    double factor = intermediate_sky_zenith(angles.altitude).diffuse_factor;
    if (clearness == 1)
        factor = kOvercastDiffuseFactor;
    else if (clearness >= 6)
        factor = clear_sky_zenith(angles.altitude).diffuse_factor;
    const double zenith = result.scale * weather.distribution.luminance(0, sun_zenith);
    const double from_sun = sky.show_sun && clearness > 1
                                ? kSunSolidAngle / kPi * result.sun * std::sin(angles.altitude)
                                : 0;
    result.ground = sky.ground_reflectance * (zenith * factor + from_sun);
    if (!std::isfinite(result.scale + result.ground + result.sun)) {
        throw InputError("gendaylit: the radiances are not finite numbers");
    }
    return result;
}

/// The pattern of a sky; `coefficients` are the first seven numbers of perezlum.cal.
std::string brightness_text(const std::string& coefficients, const Vec3& sun) {
    return "\nvoid brightfunc skyfunc\n2 skybright perezlum.cal\n0\n10 " + coefficients + " " +
           direction_text(sun) + "\n";
}

std::string colored_text(const std::string& coefficients, const Vec3& sun, double clearness,
                         const DaylightLocus& locus) {
    std::string text =
        "\nvoid colorfunc skyfunc\n4 skybright_r skybright_g skybright_b perezlum_c.cal\n"
        "0\n22 " +
        coefficients + " " + direction_text(sun) + " " + fixed(clearness, 6);
    for (const double number : locus) text += " " + general(number, 12);
    return text + "\n";
}

std::string sky_text(const DaylitOptions& sky, const Weather& weather, const SkyOutput& output,
                     const Vec3& sun, WarningSink& warnings) {
    constexpr double kOvercast = 1.065;
    constexpr double kClear = 4.5;
    std::string coefficients = scientific(output.scale, 3) + " " + scientific(output.ground, 3);
    const PerezDistribution& perez = weather.distribution;
    for (const double value : {perez.a, perez.b, perez.c, perez.d, perez.e}) {
        coefficients += " " + fixed(value, 6);
    }
    const double clearness = weather.condition.clearness;
    if (sky.colored && (clearness <= kOvercast || clearness >= kClear)) {
        return colored_text(coefficients, sun, clearness, sky.locus);
    }
    if (sky.colored)
        warnings.warn("gendaylit: no color for a sky that is neither overcast nor clear");
    return brightness_text(coefficients, sun);
}

std::string gendaylit_defaults() {
    const DaylitOptions sky;
    return default_line("-P 0 0", "sky clearness and brightness") +
           default_line("-O 0", "output: visible radiance") +
           default_line("-g " + fixed(sky.ground_reflectance, 6), "ground reflectance") +
           default_line("-d " + fixed(sky.dew_point, 6), "dew point, degrees Celsius") +
           default_line("-i " + fixed(sky.interval, 6), "measurement interval, minutes") +
           default_line("-a " + fixed(sky.site.latitude * 180 / kPi, 6),
                        "latitude, degrees north") +
           default_line("-o " + fixed(sky.site.longitude * 180 / kPi, 6),
                        "longitude, degrees west") +
           default_line("-m " + fixed(sky.site.meridian * 180 / kPi, 6),
                        "standard meridian, degrees west");
}

/// Altitude and azimuth, and what was said about them; false when the sun is not up.
bool place_sun(const DaylitOptions& sky, SolarAngles& angles, std::string& text) {
    bool up = true;
    double hour = 0;
    if (sky.moment.angles) {
        angles = *sky.moment.angles;
    } else {
        SolarTime time = solar_time(sky.moment.date, sky.site);
        up = adjust_to_daylight(sky, time.hour);
        hour = time.hour;
        angles = solar_angles(time, sky.site);
    }
    text += time_comment(hour);
    return up;
}

std::string daylit_sky(std::span<const std::string> args, const DaylitOptions& sky,
                       WarningSink& warnings) {
    std::string text = command_comment(args);
    SolarAngles angles;
    const bool up = place_sun(sky, angles, text);
    if (sky.limit_altitude && angles.altitude > kMaxSkyAltitude) {
        warnings.warn(args[0] + ": the sun is too close to the zenith, lowered to 87 degrees");
        angles.altitude = kMaxSkyAltitude;
    }
    text += angles_comment(angles);
    const Vec3 direction = solar_direction(angles);
    const int day = sky.moment.angles ? 0 : day_of_year(sky.moment.date.month, sky.moment.date.day);
    const PerezSun sun{std::min(kPi / 2 - angles.altitude, kPi / 2),
                       extraterrestrial_irradiance(day)};
    Weather weather;
    if (up)
        weather = weather_of(sky, angles.altitude, sun, args[0], warnings);
    else
        weather.fault = "the sun is not up";
    if (!weather.fault.empty()) {
        warnings.warn(args[0] + ": " + weather.fault + ", the sky is black");
        return text + brightness_text("0 0 0 0 0 0 0", direction);
    }
    const double water = std::exp(0.07 * sky.dew_point - 0.075);
    text += "# Sky clearness, brightness and precipitable water: " +
            fixed(weather.condition.clearness, 6) + " " + fixed(weather.condition.brightness, 6) +
            " " + fixed(water, 6) + "\n";
    if (sky.input == WeatherInput::global) {
        text += "# Direct normal irradiance: " + fixed(weather.irradiance.direct, 1) +
                "\n# Diffuse horizontal irradiance: " + fixed(weather.irradiance.diffuse, 1) + "\n";
    }
    const SkyOutput output = sky_output(sky, weather, angles, sun.zenith);
    if (sky.show_sun) {
        const bool shines = weather.condition.clearness > 1;
        text += sun_text(shines ? scientific(output.sun, 3) : "0.0", direction, kSunAngle);
    }
    return text + sky_text(sky, weather, output, direction, warnings);
}

}  // namespace

SkyDetails gendaylit_details(std::span<const std::string> words) {
    GeneratorWords all(words, kGendaylitUsage);
    NoWarnings quiet;
    const DaylitOptions sky = parse_gendaylit(all, quiet);
    return {sky.moment, sky.site, {}};
}

std::string run_gendaylit(std::span<const std::string> args, GeneratorContext& context) {
    if (args.size() == 2 && args[1] == "-defaults") return gendaylit_defaults();
    WarningList warnings;
    GeneratorWords words(args, kGendaylitUsage);
    const DaylitOptions sky = parse_gendaylit(words, warnings);
    std::string text = daylit_sky(args, sky, warnings);
    if (!sky.quiet) warnings.forward(context.warnings);
    return text;
}

}  // namespace lightwalk
