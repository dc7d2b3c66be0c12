#include "core/ambient/ambient_record.h"

#include <algorithm>
#include <cmath>

#include "core/ambient/quadratic.h"
#include "core/math/direction_code.h"

namespace lightwalk {
namespace {

constexpr double kLeastExtrapolation = 0.05, kMostExtrapolation = 20;  ///< of extrapolation
constexpr double kSlack = 0.01;  ///< of the long radius: more than coded axes tilt the ellipse
constexpr double kNearAngle = 10 * kPi / 180;  ///< between normals, before -aa is added

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Where the record's normal, lengthened, is seen from the point 20 degrees above its horizon;
/// nothing: nowhere.
std::optional<double> height_above_horizon(const DecodedRecord& record, const AmbientQuery& query,
                                           const Vec3& to_record) {
    constexpr double kCosine2 = 0.1169778;  // cos² 70°
    const double a = dot(record.n(), query.normal), b = dot(to_record, query.normal);
    const Roots roots =
        solve_quadratic(a * a - kCosine2, 2 * (a * b - kCosine2 * dot(to_record, record.n())),
                        b * b - kCosine2 * length_squared(to_record));
    if (roots.count < 2) return std::nullopt;
    return std::max(roots.root[0], roots.root[1]);
}

bool is_hidden(const DecodedRecord& record, const AmbientQuery& query, double a, double b,
               LeakTest leaks) {
    double azimuth = std::atan2(b, a);
    if (azimuth < 0) azimuth += 2 * kPi;
    const auto flag = std::min(static_cast<unsigned>(azimuth * 16 / kPi), 31U);
    if ((record.corral >> flag & 1U) == 0) return false;
    const Vec3 position{record.position[0], record.position[1], record.position[2]};
    const Vec3 to_record = position - query.position;
    const std::optional<double> height = height_above_horizon(record, query, to_record);
    if (!height) return true;
    if (*height <= kEpsilon) return false;
    return leaks(position + record.n() * *height);
}

}  // namespace

DecodedRecord::DecodedRecord(const AmbientRecord& record)
    : position(record.position),
      normal(floats(decode_direction(record.normal))),
      axis(floats(decode_direction(record.axis))),
      radius(record.radius),
      translation(record.translation),
      rotation(record.rotation),
      value(record.value),
      weight(record.weight),
      corral(record.corral),
      level(record.level) {}

double largest_angle(double accuracy, double query_weight, bool has_level) {
    const double angle = kNearAngle + accuracy;
    if (!has_level || query_weight >= 0.6) return angle;
    return kPi / 2 + (angle - kPi / 2) * std::pow(query_weight, 0.13);
}

double extrapolated(const DecodedRecord& record, const Vec3& offset, const Vec3& shading_normal) {
    const Vec3 n = record.n(), u = record.u(), v = cross(n, u);
    const Vec3 turn = cross(n, shading_normal);
    const double factor = 1 + static_cast<double>(record.translation[0]) * dot(offset, u) +
                          static_cast<double>(record.translation[1]) * dot(offset, v) +
                          static_cast<double>(record.rotation[0]) * dot(turn, u) +
                          static_cast<double>(record.rotation[1]) * dot(turn, v);
    return std::clamp(factor, kLeastExtrapolation, kMostExtrapolation);
}

RecordReach reach_of(const DecodedRecord& record, const AmbientLimits& limits) {
    const double r0 = limits.accuracy * static_cast<double>(record.radius[0]),
                 r1 = limits.accuracy * static_cast<double>(record.radius[1]);
    const double below = std::min(limits.accuracy * limits.least_radius, r0);
    const Vec3 n = record.n(), u = record.u(), v = cross(n, u);
    RecordReach reach;
    for (std::size_t k = 0; k < 3; ++k) {
        const double wide = std::hypot(r0 * u[k], r1 * v[k]) + kSlack * r1;
        const double at = static_cast<double>(record.position[k]);
        reach.low[k] = at - wide + std::min(-below * n[k], r0 * n[k]);
        reach.high[k] = at + wide + std::max(-below * n[k], r0 * n[k]);
    }
    return reach;
}

RecordUse use_of(const DecodedRecord& record, const AmbientQuery& query,
                 const AmbientLimits& limits, double most_angle, LeakTest leaks) {
    const Vec3 n = record.n();
    const double cosine = dot(n, query.normal);
    if (cosine <= 0) return {};
    const double angle2 = std::max(0.0, 2 - 2 * cosine);
    if (angle2 >= most_angle * most_angle) return {};
    const Vec3 offset =
        query.position - Vec3{record.position[0], record.position[1], record.position[2]};
    const double height = dot(offset, n), aa = limits.accuracy;
    if (height < -limits.least_radius * aa) return {};
    const double r0 = static_cast<double>(record.radius[0]),
                 r1 = static_cast<double>(record.radius[1]);
    double distance2 = height * height / (r0 * r0);
    if (distance2 >= aa * aa) return {};
    const Vec3 u = record.u();
    const double a = dot(offset, u), b = dot(offset, cross(n, u));
    distance2 += a * a / (r0 * r0) + b * b / (r1 * r1);
    if (distance2 >= aa * aa) return {};
    if (record.corral != 0 && is_hidden(record, query, a, b, leaks)) return {};
    const double factor = extrapolated(record, offset, query.shading_normal);
    if (factor <= kLeastExtrapolation) return {};
    return {(1 - std::sqrt(angle2) / most_angle) * (1 - std::sqrt(distance2) / aa), factor};
}

void add_record(const DecodedRecord& record, const AmbientQuery& query, const AmbientLimits& limits,
                double most_angle, LeakTest leaks, AmbientSum& sum) {
    const RecordUse use = use_of(record, query, limits, most_angle, leaks);
    if (use.weight <= 0) return;
    sum.weight += use.weight;
    for (std::size_t k = 0; k < 3; ++k)
        sum.sum[k] += use.weight * use.factor * static_cast<double>(record.value[k]);
}

}  // namespace lightwalk
