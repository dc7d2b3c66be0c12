#include "core/glare/glare_indices.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

/// Sums over the sources.
struct SourceSums {
    double direct = 0;     ///< illuminance at the eye [lx]
    double glare = 0;      ///< of L² ω / P²
    double sensation = 0;  ///< of M (VCP), times the mean luminance to the power of 0.44
    double veil = 0;       ///< veiling luminance [cd/m²]
    double evalglare_veil = 0;
};

SourceSums sums_of(const GlareReport& report, const Vec3& forward) {
    SourceSums sums;
    for (const GlareSource& s : report.sources) {
        const double cosine = std::clamp(dot(s.direction, forward), -1., 1.);
        const double degrees = std::max(std::acos(cosine) * 180 / kPi, 0.1);
        const double q = 20.4 * s.solid_angle + 1.52 * std::pow(s.solid_angle, 0.2) - 0.075;
        sums.direct += s.illuminance;
        sums.glare += s.glare;
        sums.sensation += 0.5 * s.luminance * q / s.position_index;
        sums.veil += 10 * s.illuminance / (degrees * degrees);
        sums.evalglare_veil += 5 * s.luminance * s.solid_angle * std::max(cosine, 0.) / degrees;
    }
    return sums;
}

double daylight_glare_index(const GlareReport& report, double background) {
    double sum = 0;
    for (const GlareSource& s : report.sources) {
        const double seen = s.solid_angle / (s.position_index * s.position_index);
        sum += std::pow(s.luminance, 1.6) * std::pow(seen, 0.8) /
               (background + 0.07 * std::sqrt(s.solid_angle) * s.luminance);
    }
    return 10 * std::log10(0.478 * sum);
}

/// The share of people that a rating of discomfort glare leaves in comfort, whose limits are
/// distributed log-normally.
double comfort_probability(double rating) {
    const double limit = 6.374 - 1.3227 * std::log(rating);
    return 50 * std::erfc(-limit / std::sqrt(2.));
}

}  // namespace

GlareIndices glare_indices(const GlareReport& report, const Vec3& forward) {
    GlareIndices indices;
    if (report.sources.empty()) return indices;
    const double ev = report.vertical_illuminance;
    const SourceSums sums = sums_of(report, forward);
    const double background = (ev - sums.direct) / kPi;
    indices.veiling_luminance = sums.veil;
    indices.evalglare_veil = sums.evalglare_veil;
    if (!(background > 0) || !(report.average_luminance > 0)) return indices;
    indices.dgi = daylight_glare_index(report, background);
    indices.ugr = 8 * std::log10(0.25 / background * sums.glare);
    indices.cgi = 8 * std::log10(2 * (1 + sums.direct / 500) / ev * sums.glare);
    const double n = static_cast<double>(report.sources.size());
    const double sensation = sums.sensation / std::pow(report.average_luminance, 0.44);
    indices.vcp = comfort_probability(std::pow(sensation, std::pow(n, -0.0914)));
    return indices;
}

}  // namespace lightwalk
