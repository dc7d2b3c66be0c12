#include "io/generators/perez_sky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/math/vec3.h"

namespace lightwalk {
namespace {

constexpr double kSolarConstant = 1367;     // [W/m²]
constexpr double kClearnessWeight = 1.041;  // weight of the cube of the zenith angle [1/rad³]

using Row = std::array<double, 4>;

/// Lower bounds of the clearness classes from the second on.
constexpr std::array<double, 7> kClassBounds = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

/// Diffuse: a + b W + c cos(zenith) + d ln(brightness).
constexpr std::array<Row, 8> kDiffuseEfficacy = {{
    {97.24, -0.46, 12.00, -8.91},
    {107.22, 1.15, 0.59, -3.95},
    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.90},
    {100.71, 5.94, -22.75, -23.74},
    {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.90, -53.24, -14.03},
    {152.23, 0.35, -45.27, -7.98},
}};

/// Direct: a + b W + c exp(5.73 zenith - 5) + d brightness.
constexpr std::array<Row, 8> kDirectEfficacy = {{
    {57.20, -4.55, -2.98, 117.12},
    {98.99, -3.46, -1.21, 12.38},
    {109.83, -4.90, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56},
    {106.36, -3.97, -1.75, -6.16},
    {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44},
    {101.18, 1.58, -1.10, -8.29},
}};

/// Per class the rows A to E; each x1 + x2 zenith + brightness (x3 + x4 zenith), but for C and D of
/// the first class.
constexpr std::array<std::array<Row, 5>, 8> kCoefficients = {{
    {{{1.3525, -0.2576, -0.2690, -1.4366},
      {-0.7670, 0.0007, 1.2734, -0.1233},
      {2.8000, 0.6004, 1.2375, 1.000},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {{{-1.2219, -0.7730, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.9750, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.1080},
      {0.2624, 0.0672, -0.2190, -0.4285}}},
    {{{-1.1000, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5000, 1.1766},
      {24.7219, -13.0812, -37.7000, 34.8438},
      {-5.0000, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {{{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3000, -62.2500, 52.0781},
      {-3.5000, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {{{-0.6000, -0.3566, -2.5000, 2.3250},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21.0000, -4.7656, -21.5906, 7.2492},
      {-3.5000, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {{{-1.0156, -0.3670, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.8500, 3.3750},
      {14.0000, -0.9999, -7.1406, 7.5469},
      {-3.4000, -0.1078, -1.0750, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {{{-1.0000, 0.0211, 0.5025, -0.5119},
      {-0.3000, 0.1922, 0.7023, -1.6317},
      {19.0000, -5.0000, 1.2438, -1.9094},
      {-4.0000, 0.0250, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {{{-1.0500, 0.0289, 0.4260, 0.3590},
      {-0.3250, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5000, -46.1148, 55.3750},
      {-7.2312, 0.4050, 13.3500, 0.6234},
      {1.5000, -0.6426, 1.8564, 0.5636}}},
}};

double zenith_term(double zenith) {
    return kClearnessWeight * zenith * zenith * zenith;
}

}  // namespace

double PerezSun::air_mass() const {
    const double degrees = zenith * 180 / kPi;
    return 1 / (std::cos(zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
}

double extraterrestrial_irradiance(int day_of_year) {
    const double day = 2 * kPi * (day_of_year - 1) / 365;
    return kSolarConstant * (1.00011 + 0.034221 * std::cos(day) + 0.00128 * std::sin(day) +
                             0.000719 * std::cos(2 * day) + 0.000077 * std::sin(2 * day));
}

SkyCondition limited(SkyCondition condition) {
    if (condition.clearness < 1) condition.clearness = 1;
    if (condition.clearness > 12.01) condition.clearness = 12.009;
    if (condition.brightness < 0.01) condition.brightness = 0.01;
    if (condition.brightness > 0.6) condition.brightness = 0.6;
    return condition;
}

SkyCondition sky_condition(const DaylightPair& irradiance, const PerezSun& sun) {
    const double k = zenith_term(sun.zenith);
    const double ratio = (irradiance.diffuse + irradiance.direct) / irradiance.diffuse;
    return limited(
        {(ratio + k) / (1 + k), irradiance.diffuse * sun.air_mass() / sun.extraterrestrial});
}

DaylightPair irradiances(const SkyCondition& condition, const PerezSun& sun) {
    const double diffuse = condition.brightness * sun.extraterrestrial / sun.air_mass();
    return {diffuse * (condition.clearness - 1) * (1 + zenith_term(sun.zenith)), diffuse};
}

std::optional<std::size_t> clearness_class(double clearness) {
    if (std::isnan(clearness)) return std::nullopt;
    const auto above = std::ranges::upper_bound(kClassBounds, clearness);
    return static_cast<std::size_t>(above - kClassBounds.begin());
}

DaylightPair luminous_efficacies(const SkyCondition& condition, const PerezSun& sun, double water) {
    const std::optional<std::size_t> sky_class = clearness_class(condition.clearness);
    if (!sky_class) return {};
    const Row& diffuse = kDiffuseEfficacy[*sky_class];
    const Row& direct = kDirectEfficacy[*sky_class];
    return {
        std::max(0.0, direct[0] + direct[1] * water + direct[2] * std::exp(5.73 * sun.zenith - 5) +
                          direct[3] * condition.brightness),
        diffuse[0] + diffuse[1] * water + diffuse[2] * std::cos(sun.zenith) +
            diffuse[3] * std::log(condition.brightness)};
}

double PerezDistribution::luminance(double zenith, double gamma) const {
    const double cosine = std::cos(gamma);
    return (1 + a * std::exp(b / std::cos(zenith))) *
           (1 + c * std::exp(d * gamma) + e * cosine * cosine);
}

double PerezDistribution::horizontal_integral(double sun_zenith) const {
    struct Band {
        double zenith;  // [deg]
        int count;
    };
    constexpr std::array<Band, 8> kBands = {
        {{84, 30}, {72, 30}, {60, 24}, {48, 24}, {36, 18}, {24, 12}, {12, 6}, {0, 1}}};
    double sum = 0;
    int count = 0;
    for (const Band& band : kBands) {
        const double zenith = band.zenith * kPi / 180;
        for (int i = 0; i < band.count; ++i) {
            const double azimuth = 2 * kPi * i / band.count;  // from the sun's
            const double cos_gamma = std::cos(zenith) * std::cos(sun_zenith) +
                                     std::sin(zenith) * std::sin(sun_zenith) * std::cos(azimuth);
            sum +=
                luminance(zenith, std::acos(std::clamp(cos_gamma, -1.0, 1.0))) * std::cos(zenith);
        }
        count += band.count;
    }
    return 2 * kPi / count * sum;
}

std::optional<PerezDistribution> perez_distribution(const SkyCondition& condition,
                                                    double sun_zenith) {
    const std::optional<std::size_t> sky_class = clearness_class(condition.clearness);
    if (!sky_class) return std::nullopt;
    const bool hazy = condition.clearness > 1.065 && condition.clearness < 2.8;
    const double brightness = hazy ? std::max(condition.brightness, 0.2) : condition.brightness;
    std::array<double, 5> value{};
    for (std::size_t i = 0; i < value.size(); ++i) {
        const Row& x = kCoefficients[*sky_class][i];
        value[i] = x[0] + x[1] * sun_zenith + brightness * (x[2] + x[3] * sun_zenith);
    }
    if (*sky_class == 0) {
        const Row& c = kCoefficients[0][2];
        const Row& d = kCoefficients[0][3];
        value[2] = std::exp(std::pow(brightness * (c[0] + c[1] * sun_zenith), c[2])) - c[3];
        value[3] = -std::exp(brightness * (d[0] + d[1] * sun_zenith)) + d[2] + brightness * d[3];
    }
    return PerezDistribution{value[0], value[1], value[2], value[3], value[4]};
}

DaylightPair split_global(double global, double extraterrestrial, double sin_altitude) {
    const double used = global > extraterrestrial ? 0.999 * extraterrestrial : global;
    const double kt = used / extraterrestrial;
    double fraction = 0.165;
    if (kt <= 0.22) {
        fraction = 1 - 0.09 * kt;
    } else if (kt <= 0.8) {
        fraction = 0.9511 + kt * (-0.1604 + kt * (4.388 + kt * (-16.638 + kt * 12.336)));
    }
    const double diffuse = used * fraction;
    return {(used - diffuse) / sin_altitude, diffuse};
}

}  // namespace lightwalk
