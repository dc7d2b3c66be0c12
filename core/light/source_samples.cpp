#include "core/light/source_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/light/spot.h"

namespace lightwalk {
namespace {

constexpr double kLeastFormFactor = 1e-4;  ///< of a local source's part: less is grazing
constexpr double kNone = -1;               ///< the solid angle where there is no sample

/// How far the apex of a spot's cone lies behind the source [m].
double apex_behind(const LightSource& source) {
    return source.spot ? static_cast<double>(source.spot->focal_length) : 0;
}

/// A glow ends here; other sources do not.
double reach_of(const LightSource& source) {
    return source.material_type == PrimitiveType::glow ? static_cast<double>(source.proximity)
                                                       : kHuge * kHuge;
}

/// From the point to a place in the source's box; to distant ones, a direction.
Vec3 way_to(const LightSource& source, const Vec3& place, const Vec3& point) {
    const double local = source.is_distant() ? 0 : 1;
    const auto along = [&](double center, double u, double v, double w, double from) {
        return center + u * place.x + v * place.y + w * place.z - local * from;
    };
    return {along(source.center.x, source.u.x, source.v.x, source.w.x, point.x),
            along(source.center.y, source.u.y, source.v.y, source.w.y, point.y),
            along(source.center.z, source.u.z, source.v.z, source.w.z, point.z)};
}

/// The solid angle of a local source's part, of which it shows `share` of its projected area.
double local_solid_angle(double share, double distance, double area, double behind, double reach) {
    const double apex = distance + behind;
    const double angle = share * area / (apex * apex);
    const bool usable = (share > kLeastFormFactor) & (distance <= reach) & (distance > 0);
    return usable ? angle : kNone;
}

/// The solid angle of a part that a sphere, a cylinder or a distant source shows.
double round_solid_angle(const LightSource& source, const Vec3& direction, double distance,
                         double share) {
    const auto size = static_cast<double>(source.size);
    if (source.is_distant()) return distance > 0 ? share * size : kNone;
    if (source.is_cylinder()) {
        const double along = dot(direction, normalize(source.u));
        share *= std::sqrt(std::max(0.0, 1 - along * along));
    }
    return local_solid_angle(share, distance, size, apex_behind(source), reach_of(source));
}

/// Of a part of the box: halves of halves, so that the product is exact.
double share_of(const SourcePart& part) {
    return part.size.x * part.size.y * part.size.z;
}

/// At the head of a loop's body: without lanes the compiler keeps its rounds apart.
template <bool kLanes>
void maybe_alone() {
    if constexpr (!kLanes) asm volatile("");
}

}  // namespace

void SourceSamples::grow() {
    const std::size_t larger = std::max<std::size_t>(64, 2 * capacity_);
    std::vector<double> rows(kRows * larger);
    for (std::size_t r = 0; r < kRows; ++r)
        std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(r * capacity_), count_,
                    rows.begin() + static_cast<std::ptrdiff_t>(r * larger));
    rows_.swap(rows);
    sources_.resize(larger);
    capacity_ = larger;
}

void SourceSamples::add(const LightSource& source, std::int32_t index, const SourcePart& part,
                        int parts, const Vec3& point, double jitter, RandomStream& random) {
    const std::size_t i = next();
    const Vec3 way = way_to(source, position_in_box(source, part, parts, jitter, random), point);
    row(kX)[i] = way.x;
    row(kY)[i] = way.y;
    row(kZ)[i] = way.z;
    row(kShare)[i] = share_of(part);
    row(kNormalX)[i] = source.normal.x;
    row(kNormalY)[i] = source.normal.y;
    row(kNormalZ)[i] = source.normal.z;
    row(kArea)[i] = static_cast<double>(source.size);
    row(kBehind)[i] = apex_behind(source);
    row(kReach)[i] = reach_of(source);
    sources_[i] = index;
}

void SourceSamples::sample(std::span<const LightSource> sources, const Vec3& point, bool lanes) {
    if (known_ == count_)
        take_known();
    else
        lanes ? aim<true>() : aim<false>();
    double* const distance = row(kDistance);
    retain([&](std::size_t i) {
        const LightSource& source = sources[static_cast<std::size_t>(sources_[i])];
        const Vec3 direction{row(kX)[i], row(kY)[i], row(kZ)[i]};
        double& angle = row(kSolidAngle)[i];
        if (!source.is_flat() || source.is_distant())
            angle = round_solid_angle(source, direction, distance[i], row(kShare)[i]);
        return angle >= 0 && !(source.spot && outside_spot(*source.spot, point, direction));
    });
}

void SourceSamples::take_known() {
    std::copy_n(row(kKnownX), count_, row(kX));
    std::copy_n(row(kKnownY), count_, row(kY));
    std::copy_n(row(kKnownZ), count_, row(kZ));
    std::copy_n(row(kKnownDistance), count_, row(kDistance));
}

/// Directions and distances, and what polygons and rings show: their part's share of the projected
/// area.
template <bool kLanes>
void SourceSamples::aim() {
    double* __restrict__ x = row(kX);
    double* __restrict__ y = row(kY);
    double* __restrict__ z = row(kZ);
    double* __restrict__ distance = row(kDistance);
    double* __restrict__ solid_angle = row(kSolidAngle);
    const double *share = row(kShare), *normal_x = row(kNormalX), *normal_y = row(kNormalY),
                 *normal_z = row(kNormalZ), *area = row(kArea), *behind = row(kBehind),
                 *reach = row(kReach);
    const std::size_t end = round_up_to_simd_width(count_);
#pragma GCC ivdep
    for (std::size_t i = 0; i < end; ++i) {
        maybe_alone<kLanes>();
        const double length = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
        const double shorter = 1 / length;
        const double to_x = x[i] * shorter, to_y = y[i] * shorter, to_z = z[i] * shorter;
        const double facing = -(normal_x[i] * to_x + normal_y[i] * to_y + normal_z[i] * to_z);
        x[i] = to_x;
        y[i] = to_y;
        z[i] = to_z;
        distance[i] = length;
        solid_angle[i] = local_solid_angle(facing * share[i], length, area[i], behind[i], reach[i]);
    }
}

void SourceSamples::move(std::size_t from, std::size_t to) {
    for (const Row r : {kX, kY, kZ, kSolidAngle}) row(r)[to] = row(r)[from];
    sources_[to] = sources_[from];
}

std::optional<SourceSample> sample_part(const LightSource& source, const SourcePart& part,
                                        int parts, const Vec3& point, double jitter,
                                        RandomStream& random) {
    const Vec3 way = way_to(source, position_in_box(source, part, parts, jitter, random), point);
    SourceSample sample;
    const double distance = length(way);
    sample.direction = way * (1 / distance);
    sample.distance = source.is_distant() ? kHuge : distance;
    if (source.is_flat() && !source.is_distant())
        sample.solid_angle = local_solid_angle(
            -dot(source.normal, sample.direction) * share_of(part), distance,
            static_cast<double>(source.size), apex_behind(source), reach_of(source));
    else
        sample.solid_angle = round_solid_angle(source, sample.direction, distance, share_of(part));
    if (!(sample.solid_angle >= 0)) return std::nullopt;
    if (source.spot && outside_spot(*source.spot, point, sample.direction)) return std::nullopt;
    return sample;
}

std::optional<SourceSample> sample_whole(const LightSource& source, const Vec3& point,
                                         double jitter, RandomStream& random) {
    return sample_part(source, kWholeBox, 1, point, jitter, random);
}

SourceBoxes::SourceBoxes(std::span<const LightSource> sources, std::span<const std::int32_t> which,
                         bool lanes)
    : lanes_(lanes), count_(round_up_to_simd_width(which.size())), rows_(kRows * count_) {
    for (std::size_t i = 0; i < which.size(); ++i) {
        const LightSource& source = sources[static_cast<std::size_t>(which[i])];
        const auto set = [&](int r, double value) {
            rows_[static_cast<std::size_t>(r) * count_ + i] = value;
        };
        const auto set_vector = [&](int first, const Vec3& v) {
            for (int k = 0; k < 3; ++k) set(first + k, v[static_cast<std::size_t>(k)]);
        };
        set_vector(kCenter, source.center);
        if (source.is_distant()) {  // as aim() calculates it
            const double size = length(source.center);
            set_vector(kKnown, source.center * (1 / size));
            set(kKnownDistance, size);
        }
        set_vector(kU, source.u);
        set_vector(kV, source.v);
        set_vector(kW, source.w);
        set_vector(kNormal, source.normal);
        set(kLocal, source.is_distant() ? 0 : 1);
        set(kFlat, source.is_flat() ? 1 : 0);
        set(kLongest, source.is_flat()
                          ? std::max(length_squared(source.u), length_squared(source.v))
                      : source.is_cylinder() ? std::numeric_limits<double>::infinity()
                                             : -1);
        set(kArea, static_cast<double>(source.size));
        set(kBehind, apex_behind(source));
        set(kReach, reach_of(source));
        set(kRadius, source.is_distant()
                         ? 0
                         : std::sqrt(std::max(length_squared(source.u), length_squared(source.v))));
    }
}

void SourceBoxes::look(const Vec3& point, const Vec3* front, double size_over_distance,
                       SourceViews& out) const {
    lanes_ ? look_at_all<true>(point, front, size_over_distance, out)
           : look_at_all<false>(point, front, size_over_distance, out);
}

template <bool kLanes>
void SourceBoxes::look_at_all(const Vec3& point, const Vec3* front, double size_over_distance,
                              SourceViews& out) const {
    constexpr double kRound = 1 + 1e-12;  // none is taken for far that Partition would divide
    if (out.count_ != count_) {
        out.count_ = count_;
        out.rows_.resize(SourceViews::kRows * count_);
    }
    const Vec3 n = front ? *front : Vec3{};
    const double size_squared = size_over_distance * size_over_distance;
    const double *c_x = row(kCenter), *c_y = row(kCenter + 1), *c_z = row(kCenter + 2),
                 *u_x = row(kU), *u_y = row(kU + 1), *u_z = row(kU + 2), *v_x = row(kV),
                 *v_y = row(kV + 1), *v_z = row(kV + 2), *w_x = row(kW), *w_y = row(kW + 1),
                 *w_z = row(kW + 2), *n_x = row(kNormal), *n_y = row(kNormal + 1),
                 *n_z = row(kNormal + 2), *local = row(kLocal), *flat = row(kFlat),
                 *longest = row(kLongest);
    double* __restrict__ x = out.rows_.data();
    double* __restrict__ y = x + count_;
    double* __restrict__ z = y + count_;
    double* __restrict__ height = z + count_;
    double* __restrict__ facing = height + count_;
    double* __restrict__ margin = facing + count_;
    const std::size_t end = round_up_to_simd_width(count_);
#pragma GCC ivdep
    for (std::size_t i = 0; i < end; ++i) {
        maybe_alone<kLanes>();
        const double to_x = c_x[i] - local[i] * point.x, to_y = c_y[i] - local[i] * point.y,
                     to_z = c_z[i] - local[i] * point.z;
        x[i] = to_x;
        y[i] = to_y;
        z[i] = to_z;
        const double reach = std::abs(n.x * u_x[i] + n.y * u_y[i] + n.z * u_z[i]) +
                             std::abs(n.x * v_x[i] + n.y * v_y[i] + n.z * v_z[i]) +
                             std::abs(n.x * w_x[i] + n.y * w_y[i] + n.z * w_z[i]);
        height[i] = n.x * to_x + n.y * to_y + n.z * to_z + kBoxMargin * reach;
        const double turned = n_x[i] * to_x + n_y[i] * to_y + n_z[i] * to_z;
        facing[i] = 1 - flat[i] - flat[i] * turned;
        margin[i] =
            (to_x * to_x + to_y * to_y + to_z * to_z) * size_squared - 4 * kRound * longest[i];
    }
}

void SourceBoxes::set_worths(std::span<const LightSource> sources,
                             std::span<const std::int32_t> which) {
    for (std::size_t i = 0; i < which.size(); ++i)
        rows_[kWorth * count_ + i] =
            static_cast<double>(sources[static_cast<std::size_t>(which[i])].worth);
}

void SourceBoxes::rate(const SourceViews& views, bool one_sided, std::span<float> sizes) const {
    lanes_ ? rate_all<true>(views, one_sided, sizes) : rate_all<false>(views, one_sided, sizes);
}

template <bool kLanes>
void SourceBoxes::rate_all(const SourceViews& views, bool one_sided, std::span<float> sizes) const {
    using From = SourceViews::Row;
    const double *x = views.row(From::kX), *y = views.row(From::kY), *z = views.row(From::kZ),
                 *height = views.row(From::kHeight), *facing = views.row(From::kFacing),
                 *local = row(kLocal), *flat = row(kFlat), *area = row(kArea),
                 *radius = row(kRadius), *worth = row(kWorth);
    const double both = one_sided ? 0 : 1;
    float* __restrict__ out = sizes.data();
    const std::size_t end = sizes.size();
#pragma GCC ivdep
    for (std::size_t i = 0; i < end; ++i) {
        maybe_alone<kLanes>();
        const double squared = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] + kEpsilon * kEpsilon;
        const double nearness = 1 / std::sqrt(squared);
        // Parts of a near source may face the point more than its middle does. No solid angle is
        // larger than a half sphere.
        const double turned = std::min(1.0, (facing[i] + 0.5 * radius[i]) * nearness);
        const double source_cosine = flat[i] * turned + (1 - flat[i]);
        const double cosine = both + (1 - both) * std::min(1.0, height[i] * nearness);
        const double spread = local[i] * (squared + area[i] * (0.5 / kPi)) + (1 - local[i]);
        const double size = worth[i] * area[i] / spread * source_cosine * cosine;
        out[i] = (height[i] + both > 0) & (facing[i] > 0) ? static_cast<float>(size) : 0.0f;
    }
}

void SourceBoxes::add_whole(std::size_t i, std::int32_t index, const SourceViews& views,
                            SourceSamples& samples) const {
    using To = SourceSamples::Row;
    const std::size_t k = samples.next();
    const Vec3 way = views.way(i);
    samples.row(To::kX)[k] = way.x;
    samples.row(To::kY)[k] = way.y;
    samples.row(To::kZ)[k] = way.z;
    samples.row(To::kShare)[k] = 1;
    samples.row(To::kNormalX)[k] = row(kNormal)[i];
    samples.row(To::kNormalY)[k] = row(kNormal + 1)[i];
    samples.row(To::kNormalZ)[k] = row(kNormal + 2)[i];
    samples.row(To::kArea)[k] = row(kArea)[i];
    samples.row(To::kBehind)[k] = row(kBehind)[i];
    samples.row(To::kReach)[k] = row(kReach)[i];
    samples.sources_[k] = index;
    if (row(kLocal)[i] > 0) return;
    samples.row(To::kKnownX)[k] = row(kKnown)[i];
    samples.row(To::kKnownY)[k] = row(kKnown + 1)[i];
    samples.row(To::kKnownZ)[k] = row(kKnown + 2)[i];
    samples.row(To::kKnownDistance)[k] = row(kKnownDistance)[i];
    ++samples.known_;
}

}  // namespace lightwalk
