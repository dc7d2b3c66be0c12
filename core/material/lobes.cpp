#include "core/material/lobes.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

/// Squares of the slopes (x, y) over those at which Ward's distribution has fallen to 1/e.
double scaled_square(double x, double y, double alpha2_u, double alpha2_v) {
    return x * x / alpha2_u + y * y / alpha2_v;
}

/// cosθ^(nu cos²φ + nv sin²φ) of a unit half vector whose cosine to the normal is `cosine`.
double ashikhmin_shape(const Vec3& h, double cosine, const LobeFrame& frame, double nu, double nv) {
    const double sine2 = 1 - cosine * cosine;
    if (!(sine2 > 0) || !(cosine > 0)) return 1;
    const double hu = dot(h, frame.u), hv = dot(h, frame.v);
    return std::pow(cosine, (nu * hu * hu + nv * hv * hv) / sine2);
}

}  // namespace

double WardReflection::eval(const Vec3& wi, double widening) const {
    const double alpha2_u = alpha_u * alpha_u + widening, alpha2_v = alpha_v * alpha_v + widening;
    const Vec3 h = wi + wo;
    const double hu = dot(h, frame.u), hv = dot(h, frame.v), hn = dot(h, frame.n);
    const double hn2 = hn * hn;
    const double slope2 = scaled_square(hu, hv, alpha2_u, alpha2_v) / hn2;
    return std::exp(-slope2) * dot(h, h) / (kPi * hn2 * hn2 * std::sqrt(alpha2_u * alpha2_v));
}

std::optional<Vec3> WardReflection::sample(const Vec3& ng, double xi1, double xi2) const {
    const FacetSlope facet = sample_ward_facet(frame, alpha_u, alpha_v, xi1, xi2);
    const Vec3 wi = reflect_off(wo, frame.n + facet.tangent, 1 + facet.squared);
    if (dot(wi, ng) <= kEpsilon) return std::nullopt;
    return wi;
}

/// Facets of half vector h have the slopes (hu, hv) / hn. A solid angle of half vectors, dh, is
/// dh / cos³ in the plane of slopes, where cos = |hn| / |h|; and one of directions is 4 |wo·h| /
/// |h| times as large as that of their half vectors, where |wo·h| = |h|² / 2. A direction below the
/// normal's horizon has the opposite half vector, which is the same facet.
double WardReflection::pdf(const Vec3& wi) const {
    const Vec3 h = wi + wo;
    const double hn = std::abs(dot(h, frame.n)), hn2 = hn * hn;
    if (!(hn2 > 0)) return 0;
    const double slope2 =
        scaled_square(dot(h, frame.u), dot(h, frame.v), alpha_u * alpha_u, alpha_v * alpha_v) / hn2;
    return std::exp(-slope2) * dot(h, h) / (2 * kPi * hn * hn2 * alpha_u * alpha_v);
}

double ward_reflection(const Vec3& h, const Vec3& n, double alpha2) {
    const double hh = dot(h, h);
    const double hn = dot(h, n);
    const double hn2 = hn * hn;
    return std::exp((hn2 - hh) / (hn2 * alpha2)) * hh / (kPi * hn2 * hn2 * alpha2);
}

double WardTransmission::eval(const Vec3& wi, double widening) const {
    const double alpha2_u = alpha_u * alpha_u + widening, alpha2_v = alpha_v * alpha_v + widening;
    const double cosines = std::sqrt(-dot(frame.n, wi) / cos_o);
    const double peak = 1 / (kPi * std::sqrt(alpha2_u * alpha2_v));
    const Vec3 h = wi - straight;
    const double hh = dot(h, h);
    constexpr double kTiny = kEpsilon * kEpsilon;
    if (hh <= kTiny) return peak * cosines;
    const double hn = dot(h, frame.n);
    const double tangent2 = 1 - hn * hn / hh;  // squared sine between h and the normal
    if (tangent2 <= kTiny) return peak * cosines;
    const double slope2 =
        scaled_square(dot(h, frame.u), dot(h, frame.v), alpha2_u, alpha2_v) / tangent2;
    return peak * std::exp(-slope2) * cosines;
}

std::optional<Vec3> WardTransmission::sample(const Vec3& ng, double xi1, double xi2) const {
    const Vec3 wi = straight + sample_ward_facet(frame, alpha_u, alpha_v, xi1, xi2).tangent;
    if (dot(wi, ng) >= -kEpsilon) return std::nullopt;
    return normalize(wi);
}

/// Samples lie in the plane of normal n through the end of `straight`, where they have the density
/// of slopes. There wi is `reach` long, and dω = |cosθi| dA / reach².
double WardTransmission::pdf(const Vec3& wi) const {
    const double cos_i = dot(wi, frame.n), reach = dot(straight, frame.n) / cos_i;
    if (!(reach > 0)) return 0;
    const Vec3 slope = wi * reach - straight;
    const double slope2 = scaled_square(dot(slope, frame.u), dot(slope, frame.v), alpha_u * alpha_u,
                                        alpha_v * alpha_v);
    return std::exp(-slope2) * reach * reach / (kPi * alpha_u * alpha_v * std::abs(cos_i));
}

double ward_transmission(const Vec3& straight, const Vec3& wi, double alpha2) {
    return std::exp((2 * dot(straight, wi) - 2) / alpha2) / (kPi * alpha2);
}

double AshikhminReflection::eval(const Vec3& wi) const {
    const Vec3 h = normalize(wi + wo);
    const double shape = ashikhmin_shape(h, dot(h, frame.n), frame, nu, nv);
    const double cos_i = dot(wi, frame.n);
    return shape * std::sqrt((nu + 1) * (nv + 1)) /
           (8 * kPi * dot(wi, h) * std::fmax(cos_i, cos_o));
}

std::optional<Vec3> AshikhminReflection::sample(const Vec3& ng, double xi1, double xi2) const {
    const std::optional<Vec3> half = sample_ashikhmin_half(frame, nu, nv, xi1, xi2);
    if (!half) return std::nullopt;
    const Vec3 wi = reflect_off(wo, *half, 1);
    if (dot(wi, ng) <= kEpsilon) return std::nullopt;
    return wi;
}

/// A solid angle of directions is 4 |wo·h| times as large as that of their half vectors. A
/// direction below the normal's horizon has the opposite half vector.
double AshikhminReflection::pdf(const Vec3& wi) const {
    const Vec3 h = normalize(wi + wo);
    const double along = std::abs(dot(wo, h)), cosine = std::abs(dot(h, frame.n));
    if (!(along > 0) || !(cosine > 0)) return 0;
    return ashikhmin_shape(h, cosine, frame, nu, nv) * std::sqrt((nu + 1) * (nv + 1)) /
           (8 * kPi * along);
}

FacetSlope sample_ward_facet(const LobeFrame& frame, double alpha_u, double alpha_v, double xi1,
                             double xi2) {
    double c = alpha_u * std::cos(2 * kPi * xi1);
    double s = alpha_v * std::sin(2 * kPi * xi1);
    const double size = std::hypot(c, s);
    c /= size;
    s /= size;
    double squared = 1;
    if (xi2 > kEpsilon) {
        squared = -std::log(xi2) / (c * c / (alpha_u * alpha_u) + s * s / (alpha_v * alpha_v));
    }
    return {(frame.u * c + frame.v * s) * std::sqrt(squared), squared};
}

std::optional<Vec3> sample_ashikhmin_half(const LobeFrame& frame, double nu, double nv, double xi1,
                                          double xi2) {
    double c = std::sqrt(nv + 1) * std::cos(2 * kPi * xi1);
    double s = std::sqrt(nu + 1) * std::sin(2 * kPi * xi1);
    const double size = std::hypot(c, s);
    c /= size;
    s /= size;
    const double cosine = std::pow(xi2, 1 / (nu * c * c + nv * s * s + 1));
    if (!(cosine > kEpsilon)) return std::nullopt;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return frame.u * (c * sine) + frame.v * (s * sine) + frame.n * cosine;
}

}  // namespace lightwalk
