#include "core/cloud/highlights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/light/partition.h"
#include "core/material/lobes.h"

namespace lightwalk {
namespace {

constexpr double kChange = 0.1;       ///< relative change of the colour that is allowed
constexpr double kLeastCosine = 0.1;  ///< more grazing views are not considered
constexpr double kLeastTurn = 0.003, kFirstTurn = 0.0125, kMostTurn = 0.8;
constexpr double kFaintShine = 0.1 * kChange;  ///< smaller shares are negligible

/// A part of a light source as seen from the surface.
struct LitPart {
    Vec3 direction;
    double distance = kHuge;  ///< [m]
    double lit = 0;           ///< solid angle times cosine [sr]
    double alpha2 = 0;        ///< of the lobe, widened by the part's size
};

/// A point of a glossy surface, and the direction to the eye.
struct SeenPoint {
    Vec3 position, normal;
    Vec3 wo;  ///< to the eye, unit
};

/// The contribution of the specular lobe to the light that a source brings to a glossy surface.
class LightOnSurface {
  public:
    LightOnSurface(const LightSource& light, const SeenPoint& at, const GlossyLobe& lobe,
                   double size_over_distance);

    /// Remove the parts that opaque surfaces hide.
    void drop_hidden(const Geometry& geometry);
    /// How far the eye may turn before the colour changes by kChange, if that is less than `most`
    /// [rad].
    [[nodiscard]] double max_view_angle(double most) const;

  private:
    [[nodiscard]] double dark_turn(const LitPart& part) const;
    [[nodiscard]] double dark_turn(double most) const;
    [[nodiscard]] double shine(const Vec3& wo) const;
    [[nodiscard]] double change(double turn, double here) const;
    [[nodiscard]] std::array<Vec3, 2> axes() const;

    const LightSource& light_;
    SeenPoint at_;
    double ratio_;  ///< of the lobe's reflectance to the diffuse one
    std::array<LitPart, kMaxParts> parts_;
    std::size_t count_ = 0;
};

/// The parts that the renderer samples.
LightOnSurface::LightOnSurface(const LightSource& light, const SeenPoint& at,
                               const GlossyLobe& lobe, double size_over_distance)
    : light_(light), at_(at), ratio_(lobe.rho / std::max(lobe.diffuse, kEpsilon)) {
    if (out_of_reach(light, at.position) || is_behind(light, at.position, at.normal)) return;
    SourceParts parts;
    Partition{light}(at.position, size_over_distance, parts);
    RandomStream random;
    for (int i = 0; i < parts.count; ++i) {
        const auto sample = sample_part(light, parts.part[static_cast<std::size_t>(i)], parts.count,
                                        at.position, 0, random);
        if (!sample) continue;
        const double cosine = dot(sample->direction, at.normal);
        if (cosine <= 0) continue;
        parts_[count_++] = {sample->direction, sample->distance, sample->solid_angle * cosine,
                            lobe.alpha * lobe.alpha + light_widening(sample->solid_angle, 0)};
    }
}

void LightOnSurface::drop_hidden(const Geometry& geometry) {
    const auto hidden = [&](const LitPart& part) {
        RaySegment ray{at_.position, part.direction, part.distance};
        if (light_.is_virtual()) ray.t_max = geometry.intersect_surface(light_.object, ray).t;
        return geometry.visibility(ray, light_.object) == Visibility::blocked;
    };
    const auto end = parts_.begin() + static_cast<std::ptrdiff_t>(count_);
    count_ = static_cast<std::size_t>(std::remove_if(parts_.begin(), end, hidden) - parts_.begin());
}

/// The ratio of specular to diffuse light that the surface sends to `wo`, over all parts of the
/// light.
double LightOnSurface::shine(const Vec3& wo) const {
    double lobe = 0, diffuse = 0;
    for (const LitPart& part : std::span(parts_.data(), count_)) {
        lobe += part.lit * ward_reflection(part.direction + wo, at_.normal, part.alpha2);
        diffuse += part.lit / kPi;
    }
    return diffuse > 0 ? ratio_ * lobe / diffuse : 0;
}

/// Two axes of turning: toward the light's mirror image, and perpendicular to that.
std::array<Vec3, 2> LightOnSurface::axes() const {
    const Vec3& l = parts_[count_ / 2].direction;
    const Vec3 image = at_.normal * (2 * dot(l, at_.normal)) - l;
    const Vec3 across = cross(at_.wo, image);
    const double size = length(across);
    const Vec3 second = size > kEpsilon ? across / size : perpendicular(at_.wo);
    return {cross(second, at_.wo), second};
}

/// The largest change of shine() when the eye turns by an angle.
double LightOnSurface::change(double turn, double here) const {
    double most = 0;
    for (const Vec3& axis : axes()) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 wo = at_.wo * std::cos(turn) + axis * (side * std::sin(turn));
            if (dot(wo, at_.normal) < kLeastCosine) continue;
            most = std::max(most, std::abs(shine(wo) - here));
        }
    }
    return most;
}

/// How far the eye may turn while the lobe reflects at most kFaintShine of a part's light: until
/// the half vector, whose turn is the eye's times the length of h, comes too near to the normal
/// [rad].
double LightOnSurface::dark_turn(const LitPart& part) const {
    const Vec3 h = part.direction + at_.wo;
    const double hn = dot(h, at_.normal), size = length(h);
    const double peak = ratio_ / (part.alpha2 * size * size);  // of the share
    if (peak <= kFaintShine) return kMostTurn;
    const double slope2 = part.alpha2 * std::log(peak / kFaintShine);
    const double sine2 = std::max(1 - hn * hn / (size * size), 0.0);
    // Avoids the arc tangent in a frequent case: the view is inside the lobe.
    if (sine2 <= slope2 * (1 - sine2)) return 0;
    const double apart = std::asin(std::sqrt(sine2)) - std::atan(std::sqrt(slope2));
    return apart * std::min(size, 1.0);
}

double LightOnSurface::dark_turn(double most) const {
    for (const LitPart& part : std::span(parts_.data(), count_)) {
        most = std::min(most, dark_turn(part));
        if (most <= 0) return 0;
    }
    return most;
}

double LightOnSurface::max_view_angle(double most) const {
    if (count_ == 0) return most;
    const double dark = dark_turn(most);
    if (dark >= most) return most;
    const double here = shine(at_.wo), allowed = kChange * (1 + here);
    double turn = 0, changed = 0;
    double next = kFirstTurn;
    for (; next <= dark; next *= 2) turn = next;
    for (; turn < most; next *= 2) {
        const double then = change(next, here);
        if (then > allowed)
            return std::min(most, turn + (next - turn) * (allowed - changed) / (then - changed));
        turn = next;
        changed = then;
    }
    return most;
}

}  // namespace

double Highlights::slope(const Hit& hit, const Vec3& direction, const GlossyLobe& lobe) const {
    const SeenPoint at{hit.position, hit.cos_out >= 0 ? hit.normal : -hit.normal, -direction};
    const double part_size = partition_size(options_.source_subdivision, 1);
    double turn = kMostTurn;
    for (const std::int32_t i : lights_.sampled()) {
        LightOnSurface light(lights_[i], at, lobe, part_size);
        if (light.max_view_angle(turn) >= turn) continue;
        light.drop_hidden(geometry_);  // expensive, and most lights do not get here
        turn = light.max_view_angle(turn);
    }
    return turn < kMostTurn ? kChange / std::max(turn, kLeastTurn) : 0;
}

}  // namespace lightwalk
