#include "core/glare/dgp.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kDegrees = 180 / kPi;
constexpr double kLargestIndex = 16;  ///< where Guth's measurements end
constexpr double kOfLight = 5.87e-5, kOfContrast = 0.0918, kAdaptation = 1.87;  ///< of DGP
constexpr double kBelowStretch = 1.15;  ///< of the height below the line of sight

/// Guth's position index.
/// @param tau    of the plane through the source and the line of sight, from upright [degrees]
/// @param sigma  from the line of sight [degrees]
double guth_index(double tau, double sigma) {
    const double linear = (35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3;
    const double square = (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5;
    return std::exp((linear + square * sigma) * sigma);
}

}  // namespace

double position_index(const Vec3& direction, const Camera& camera) {
    const double ahead = dot(direction, camera.forward());
    const double aside = std::abs(dot(direction, camera.right()));
    const double above = dot(direction, camera.upward());
    const double height = above < 0 ? kBelowStretch * above : above;
    const double tau = above < 0 ? 90 : std::atan2(aside, above) * kDegrees;
    const double sigma = std::atan2(std::hypot(aside, height), ahead) * kDegrees;
    return std::min(guth_index(tau, sigma), kLargestIndex);
}

double daylight_glare_probability(double ev, double sum) {
    const double contrast = sum > 0 && ev > 0 ? sum / std::pow(ev, kAdaptation) : 0;
    return std::min(kOfLight * ev + kOfContrast * std::log10(1 + contrast) + 0.16, 1.);
}

DgpSlopes dgp_slopes(double ev, double sum) {
    if (daylight_glare_probability(ev, sum) >= 1) return {};
    if (!(ev > 0)) return {kOfLight, 0};
    const double contrast = sum / std::pow(ev, kAdaptation);
    const double slope = kOfContrast / std::log(10) / (1 + contrast);
    return {kOfLight - slope * kAdaptation * contrast / ev, slope / std::pow(ev, kAdaptation)};
}

double low_light_correction(double ev) {
    return 1 / (1 + std::exp(4 - 0.024 * ev));
}

bool within_assessments(double dgp, double ev) {
    return dgp >= 0.2 && dgp <= 0.8 && ev >= 380;
}

GlareClass glare_class(double dgp) {
    if (dgp <= 0.35) return GlareClass::imperceptible;
    if (dgp <= 0.40) return GlareClass::perceptible;
    return dgp <= 0.45 ? GlareClass::disturbing : GlareClass::intolerable;
}

}  // namespace lightwalk
