#include "core/material/lobes.h"

#include <cmath>

namespace lightwalk {

double ward_reflection(const Vec3& h, const Vec3& n, double alpha2) {
    const double hh = dot(h, h);
    const double hn = dot(h, n);
    const double hn2 = hn * hn;
    return std::exp((hn2 - hh) / (hn2 * alpha2)) * hh / (kPi * hn2 * hn2 * alpha2);
}

double ward_reflection(const Vec3& h, const LobeFrame& frame, double alpha2_u, double alpha2_v) {
    const double hu = dot(h, frame.u), hv = dot(h, frame.v), hn = dot(h, frame.n);
    const double hn2 = hn * hn;
    const double slope2 = (hu * hu / alpha2_u + hv * hv / alpha2_v) / hn2;
    return std::exp(-slope2) * dot(h, h) / (kPi * hn2 * hn2 * std::sqrt(alpha2_u * alpha2_v));
}

double ward_transmission(const Vec3& w, const Vec3& l, double alpha2) {
    return std::exp((2 * dot(w, l) - 2) / alpha2) / (kPi * alpha2);
}

double ward_transmission(const Vec3& h, const LobeFrame& frame, double alpha2_u, double alpha2_v) {
    const double peak = 1 / (kPi * std::sqrt(alpha2_u * alpha2_v));
    const double hh = dot(h, h);
    constexpr double kTiny = kEpsilon * kEpsilon;
    if (hh <= kTiny) return peak;
    const double hn = dot(h, frame.n);
    const double tangent2 = 1 - hn * hn / hh;  // squared sine between h and the normal
    if (tangent2 <= kTiny) return peak;
    const double hu = dot(h, frame.u), hv = dot(h, frame.v);
    return peak * std::exp(-(hu * hu / alpha2_u + hv * hv / alpha2_v) / tangent2);
}

double ashikhmin_reflection(const Vec3& l, const Vec3& v, double cos_v, const LobeFrame& frame,
                            double nu, double nv) {
    const Vec3 h = normalize(l - v);
    const double c = dot(h, frame.n);
    const double sine2 = 1 - c * c;
    double shape = 1;
    if (sine2 > 0 && c > 0) {
        const double hu = dot(h, frame.u), hv = dot(h, frame.v);
        shape = std::pow(c, (nu * hu * hu + nv * hv * hv) / sine2);
    }
    const double cos_l = dot(l, frame.n);
    return shape * std::sqrt((nu + 1) * (nv + 1)) / (8 * kPi * dot(l, h) * std::fmax(cos_l, cos_v));
}

}  // namespace lightwalk
