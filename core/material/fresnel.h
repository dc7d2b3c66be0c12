#pragma once
// Reflection at smooth boundaries. Source of the exact forms: Born & Wolf, "Principles of Optics",
// section 1.5.
#include <algorithm>
#include <cmath>

namespace lightwalk {

/// Reflectance that Fresnel's law adds to a smooth coating of index about 1.5, relative to normal
/// incidence: 0 at normal incidence, 0.997 at grazing. The exponential fit of Radiance's smooth
/// plastic and metal.
[[nodiscard]] inline double fresnel_estimate(double cosine) {
    return std::exp(-5.85 * cosine) - 0.00287989916;
}
/// Specularities below this are taken for matte paint, to which fresnel_estimate does not apply.
inline constexpr double kMinFresnelSpecularity = 0.017999;

/// Reflectances of a boundary for the two polarisations of light.
struct PolarizedReflectance {
    double perpendicular = 1, parallel = 1;
};

/// Fresnel's equations for a boundary between two transparent media.
/// @param cos_i  cosine of incidence, >= 0
/// @param cos_t  cosine of refraction, >= 0
/// @param eta    index behind the boundary over index before it
[[nodiscard]] inline PolarizedReflectance fresnel(double cos_i, double cos_t, double eta) {
    const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const double p = (cos_t - eta * cos_i) / (cos_t + eta * cos_i);
    return {s * s, p * p};
}

/// How a boundary between two media divides the radiance of a ray.
struct Refraction {
    double reflectance = 1;
    double transmittance = 0;  ///< factor of radiance: (1 - R) eta², eta = n_before / n_behind
    double cos_t = 0;          ///< cosine of refraction
};

/// Reflection and refraction of unpolarised light at a boundary; total reflection when there is no
/// refracted ray.
/// @param cos_i  cosine of incidence, >= 0
/// @param eta    index before the boundary over index behind it
[[nodiscard]] inline Refraction refract(double cos_i, double eta) {
    const double cos2_t = 1 - eta * eta * (1 - cos_i * cos_i);
    if (!(cos2_t >= 1e-6) || !(eta > 0)) return {};
    const double cos_t = std::sqrt(cos2_t);
    const PolarizedReflectance r = fresnel(cos_i, cos_t, 1 / eta);
    const double reflectance = 0.5 * (r.perpendicular + r.parallel);
    return {reflectance, (1 - reflectance) * eta * eta, cos_t};
}

/// Cosine to the normal, inside a pane of index `index`, of light that meets it at `cosine`.
[[nodiscard]] inline double cosine_in_pane(double cosine, double index) {
    return std::sqrt(std::max(0.0, 1 - (1 - cosine * cosine) / (index * index)));
}

/// Transmittance of a pane with all its internal reflections, for one polarisation.
/// @param r         reflectance of either boundary
/// @param internal  what one crossing of the pane leaves of the light
[[nodiscard]] inline double pane_transmittance(double r, double internal) {
    const double lost = 1 - r * r * internal * internal;
    return lost > 0 ? (1 - r) * (1 - r) * internal / lost : 0;
}

/// Reflectance of a pane, of both boundaries with all internal reflections, for one polarisation.
/// @param r         reflectance of either boundary
/// @param internal  what one crossing of the pane leaves of the light
[[nodiscard]] inline double pane_reflectance(double r, double internal) {
    const double twice = internal * internal;
    const double lost = 1 - r * r * twice;
    return lost > 0 ? r * (1 + (1 - 2 * r) * twice) / lost : 1;
}

}  // namespace lightwalk
