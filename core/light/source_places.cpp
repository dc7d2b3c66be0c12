// Samples of a source at many places, side by side.
#include <algorithm>
#include <cmath>

#include "core/light/partition.h"
#include "core/light/spot.h"

namespace lightwalk {
namespace {

constexpr double kLeastFormFactor = 1e-4;  ///< of a local source's part: less is grazing
constexpr double kNone = -1;               ///< the solid angle where there is no sample

double apex_behind(const LightSource& source) {
    return source.spot ? static_cast<double>(source.spot->focal_length) : 0;
}

/// A glow ends here; other sources do not.
double reach_of(const LightSource& source) {
    return source.material_type == PrimitiveType::glow ? static_cast<double>(source.proximity)
                                                       : kHuge * kHuge;
}

}  // namespace

void SourcePlaces::grow() {
    const std::size_t larger = std::max<std::size_t>(64, 2 * capacity_);
    std::vector<double> rows(kRows * larger);
    for (std::size_t r = 0; r < kRows; ++r)
        std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(r * capacity_), count_,
                    rows.begin() + static_cast<std::ptrdiff_t>(r * larger));
    rows_.swap(rows);
    numbers_.resize(larger);
    capacity_ = larger;
}

void SourcePlaces::add(const LightSource& source, const SourcePart& part, int parts,
                       const Vec3& point, std::uint32_t number, double jitter,
                       RandomStream& random) {
    if (count_ == capacity_) grow();
    const std::size_t i = count_++;
    const Vec3 place = position_in_box(source, part, parts, jitter, random);
    row(kFromX)[i] = point.x;
    row(kFromY)[i] = point.y;
    row(kFromZ)[i] = point.z;
    row(kPlaceX)[i] = place.x;
    row(kPlaceY)[i] = place.y;
    row(kPlaceZ)[i] = place.z;
    // Parts are halves of halves: the product is exact.
    row(kShare)[i] = part.size.x * part.size.y * part.size.z;
    numbers_[i] = number;
}

void SourcePlaces::sample(const LightSource& source) {
    aim(source);
    if (source.distant)
        weigh_distant(source);
    else if (source.flat)
        weigh_flat(source);
    else
        weigh_solid(source);
    if (source.spot) leave_spot(source);
}

/// Directions and distances.
void SourcePlaces::aim(const LightSource& source) {
    const Vec3 c = source.center, u = source.u, v = source.v, w = source.w;
    const double local = source.distant ? 0 : 1;
    const double *from_x = row(kFromX), *from_y = row(kFromY), *from_z = row(kFromZ);
    const double *place_x = row(kPlaceX), *place_y = row(kPlaceY), *place_z = row(kPlaceZ);
    double* __restrict__ x = row(kX);
    double* __restrict__ y = row(kY);
    double* __restrict__ z = row(kZ);
    double* __restrict__ distance = row(kDistance);
#pragma GCC ivdep
    for (std::size_t i = 0; i < count_; ++i) {
        const double a = place_x[i], b = place_y[i], d = place_z[i];
        const double to_x = c.x + u.x * a + v.x * b + w.x * d - local * from_x[i],
                     to_y = c.y + u.y * a + v.y * b + w.y * d - local * from_y[i],
                     to_z = c.z + u.z * a + v.z * b + w.z * d - local * from_z[i];
        const double length = std::sqrt(to_x * to_x + to_y * to_y + to_z * to_z);
        const double shorter = 1 / length;
        x[i] = to_x * shorter;
        y[i] = to_y * shorter;
        z[i] = to_z * shorter;
        distance[i] = length;
    }
}

/// Polygons and rings: the part's share of the projected area.
void SourcePlaces::weigh_flat(const LightSource& source) {
    const Vec3 n = source.normal;
    const double area = static_cast<double>(source.size), behind = apex_behind(source),
                 reach = reach_of(source);
    const double *x = row(kX), *y = row(kY), *z = row(kZ), *distance = row(kDistance),
                 *share = row(kShare);
    double* __restrict__ solid_angle = row(kSolidAngle);
#pragma GCC ivdep
    for (std::size_t i = 0; i < count_; ++i) {
        const double s = -(n.x * x[i] + n.y * y[i] + n.z * z[i]) * share[i];
        const double apex = distance[i] + behind;
        const double angle = s * area / (apex * apex);
        const bool usable = (s > kLeastFormFactor) & (distance[i] <= reach) & (distance[i] > 0);
        solid_angle[i] = usable ? angle : kNone;
    }
}

void SourcePlaces::weigh_distant(const LightSource& source) {
    const double size = static_cast<double>(source.size);
    for (std::size_t i = 0; i < count_; ++i) {
        row(kSolidAngle)[i] = row(kDistance)[i] > 0 ? row(kShare)[i] * size : kNone;
        row(kDistance)[i] = kHuge;
    }
}

/// Spheres and cylinders.
void SourcePlaces::weigh_solid(const LightSource& source) {
    const Vec3 axis = source.cylinder ? normalize(source.u) : Vec3{};
    const double area = static_cast<double>(source.size), behind = apex_behind(source),
                 reach = reach_of(source);
    const double *x = row(kX), *y = row(kY), *z = row(kZ), *distance = row(kDistance),
                 *share = row(kShare);
    double* __restrict__ solid_angle = row(kSolidAngle);
    for (std::size_t i = 0; i < count_; ++i) {
        const double along = x[i] * axis.x + y[i] * axis.y + z[i] * axis.z;
        const double across = source.cylinder ? std::sqrt(std::max(0.0, 1 - along * along)) : 1;
        const double s = across * share[i];
        const double apex = distance[i] + behind;
        const bool usable = s > kLeastFormFactor && distance[i] <= reach && distance[i] > 0;
        solid_angle[i] = usable ? s * area / (apex * apex) : kNone;
    }
}

void SourcePlaces::leave_spot(const LightSource& source) {
    for (std::size_t i = 0; i < count_; ++i) {
        const Vec3 from{row(kFromX)[i], row(kFromY)[i], row(kFromZ)[i]},
            direction{row(kX)[i], row(kY)[i], row(kZ)[i]};
        if (row(kSolidAngle)[i] >= 0 && outside_spot(*source.spot, from, direction))
            row(kSolidAngle)[i] = kNone;
    }
}

}  // namespace lightwalk
