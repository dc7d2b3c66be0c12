#include "core/light/partition.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/light/spot.h"

namespace lightwalk {
namespace {

constexpr double kSquareToDisk =
    1.12837917;  ///< 2/√π: half width of the disk around a square of equal area
/// Squared radius of a cylinder over the squared half width of its box: 1 / kCylinderBox² to
/// Radiance's digits.
constexpr double kCylinderOverBoxSquared = 1.365;
constexpr double kFullJitter = 0.7;  ///< above it single samples fill round sources, too

/// Flat sources: halve the longer side until both are short for their distance.
class FlatPartition {
  public:
    /// @param u_reach, v_reach  how far away half axes of these lengths need not be halved [m]
    FlatPartition(const LightSource& source, const Vec3& to_center, double u_reach, double v_reach,
                  SourceParts& parts)
        : to_center_(to_center), u_(source.u), v_(source.v), parts_(parts) {
        split(kWholeBox, u_reach, v_reach, kMaxParts);
    }

  private:
    void split(const SourcePart& part, double u_reach, double v_reach, int budget) {
        const Vec3 away = to_center_ - u_ * part.center.x - v_ * part.center.y;
        const double longest = std::max(u_reach, v_reach);
        if (budget < 2 || length_squared(away) >= longest * longest) {
            parts_.part[static_cast<std::size_t>(parts_.count++)] = part;
            return;
        }
        const std::size_t axis = u_reach > v_reach ? 0 : 1;
        SourcePart half = part;
        half.size[axis] *= 0.5;
        (axis == 0 ? u_reach : v_reach) *= 0.5;
        half.center[axis] = part.center[axis] - half.size[axis];
        split(half, u_reach, v_reach, budget / 2);
        half.center[axis] = part.center[axis] + half.size[axis];
        split(half, u_reach, v_reach, budget / 2);
    }

    Vec3 to_center_, u_, v_;
    SourceParts& parts_;
};

/// Cylinders: halve along the axis.
class CylinderPartition {
  public:
    CylinderPartition(const LightSource& source, const Vec3& point, double size_over_distance,
                      SourceParts& parts)
        : to_center_(point - source.center), u_(source.u), parts_(parts) {
        const Vec3 axis = normalize(u_);
        const double along = dot(to_center_, axis), distance_squared = length_squared(to_center_);
        const double axis_distance_squared = distance_squared - along * along;
        const double radius_squared = kCylinderOverBoxSquared * length_squared(source.v);
        if (axis_distance_squared <= radius_squared) return;
        const double reach = 2 * length(u_) / size_over_distance;
        if (axis_distance_squared <= 4 * radius_squared || distance_squared >= reach * reach) {
            parts_.part[0] = kWholeBox;
            parts_.count = 1;
            return;
        }
        split(kWholeBox, reach, kMaxParts);
    }

  private:
    void split(const SourcePart& part, double reach, int budget) {
        const Vec3 away = to_center_ - u_ * part.center.x;
        if (budget < 2 || length_squared(away) >= reach * reach) {
            parts_.part[static_cast<std::size_t>(parts_.count++)] = part;
            return;
        }
        SourcePart half = part;
        half.size.x *= 0.5;
        half.center.x = part.center.x - half.size.x;
        split(half, 0.5 * reach, budget / 2);
        half.center.x = part.center.x + half.size.x;
        split(half, 0.5 * reach, budget / 2);
    }

    Vec3 to_center_, u_;
    SourceParts& parts_;
};

/// Whether samples of a round source fill its disk or ball; single ones that are jittered less
/// stay in the sampling box.
bool is_squeezed(const LightSource& source, int parts, double jitter) {
    return source.is_round() && (parts > 1 || jitter > kFullJitter);
}

/// Squeeze a position in the sampling box of a round source to its disk or ball.
Vec3 squeeze(const LightSource& source, const Vec3& a) {
    if (source.is_flat() || source.is_distant()) {
        return {a.x * kSquareToDisk * std::sqrt(1 - 0.5 * a.y * a.y),
                a.y * kSquareToDisk * std::sqrt(1 - 0.5 * a.x * a.x), 0};
    }
    const double squared = length_squared(a);
    if (squared <= 0) return {};
    const double longest = std::max(std::abs(a.x), std::max(std::abs(a.y), std::abs(a.z)));
    return a * (longest / (kSphereBox * std::sqrt(squared)));
}

/// A position before it was squeezed, and how much denser squeezing has made the samples there.
struct Unsqueezed {
    Vec3 position;
    double denser = 1;
};

/// Inverse of the elliptical map of a square to a disk. Source: Fong, "Analytical Methods for
/// Squaring the Disc", 2015. Its Jacobian: (1 - x²/2 - y²/2) / sqrt((1 - x²/2) (1 - y²/2)).
Unsqueezed unsqueeze_disk(const Vec3& squeezed) {
    const double u = squeezed.x / kSquareToDisk, v = squeezed.y / kSquareToDisk;
    const double twice = 2 * std::sqrt(2.0), difference = u * u - v * v;
    const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
    const double x = 0.5 * (root(2 + difference + twice * u) - root(2 + difference - twice * u));
    const double y = 0.5 * (root(2 - difference + twice * v) - root(2 - difference - twice * v));
    const double less_x = 1 - 0.5 * x * x, less_y = 1 - 0.5 * y * y;
    return {{x, y, 0},
            std::sqrt(less_x * less_y) / ((less_x + less_y - 1) * kSquareToDisk * kSquareToDisk)};
}

/// Cubic shells are squeezed to spherical ones: each direction is scaled by its own factor.
Unsqueezed unsqueeze_ball(const Vec3& squeezed) {
    const double size = length(squeezed);
    if (!(size > 0)) return {};
    const double longest =
        std::max(std::abs(squeezed.x), std::max(std::abs(squeezed.y), std::abs(squeezed.z)));
    const double scale = kSphereBox * size / longest;
    return {squeezed * scale, scale * scale * scale};
}

}  // namespace

bool out_of_reach(const LightSource& source, const Vec3& point) {
    if (source.beam && !source.beam->may_reach(point)) return true;
    if (source.is_distant() || source.material_type != PrimitiveType::glow) return false;
    const double reach = static_cast<double>(source.proximity) + static_cast<double>(source.radius);
    return length_squared(point - source.center) > reach * reach;
}

bool is_behind(const LightSource& source, const Vec3& point, const Vec3& normal) {
    const double height =
        dot(normal, source.is_distant() ? source.center : source.center - point);  // of the centre
    if (height >= 0) return false;
    const double reach = std::abs(dot(normal, source.u)) + std::abs(dot(normal, source.v)) +
                         std::abs(dot(normal, source.w));
    return height + kBoxMargin * reach < 0;
}

double partition_size(double subdivision, double weight) {
    return subdivision > kEpsilon && weight > 0 ? subdivision / weight : 0;
}

Vec3 position_in_box(const LightSource& source, const SourcePart& part, int parts, double jitter,
                     RandomStream& random) {
    Vec3 a = part.center;
    if (jitter > 0) {
        const auto [x, y] = random.next_pair();
        a.x += jitter * (1 - 2 * x) * part.size.x;
        a.y += jitter * (1 - 2 * y) * part.size.y;
        const bool plane = source.is_flat() || source.is_distant();
        if (!plane) a.z += jitter * (1 - 2 * random.next()) * part.size.z;
    }
    return is_squeezed(source, parts, jitter) ? squeeze(source, a) : a;
}

double position_pdf(const LightSource& source, const SourcePart& part, int parts, double jitter,
                    const Vec3& position) {
    const bool plane = source.is_flat() || source.is_distant();
    Unsqueezed at{position, 1};
    if (is_squeezed(source, parts, jitter))
        at = plane ? unsqueeze_disk(position) : unsqueeze_ball(position);
    double pdf = at.denser;
    for (std::size_t i = 0; i < (plane ? 2 : 3); ++i) {
        const double reach = jitter * part.size[i];
        if (!(std::abs(at.position[i] - part.center[i]) <= reach)) return 0;
        pdf /= 2 * reach;
    }
    return pdf;
}

Partition::Partition(const LightSource& source)
    : source_(source),
      longest_squared_(std::max(length_squared(source.u), length_squared(source.v))) {}

/// Whether a flat source need not be divided. May be false though it need not.
bool Partition::is_far(const Vec3& to_center, double size_over_distance) const {
    constexpr double kRound = 1 + 1e-12;
    return length_squared(to_center) * size_over_distance * size_over_distance >
           4 * kRound * longest_squared_;
}

void Partition::operator()(const Vec3& point, double size_over_distance, SourceParts& parts) const {
    parts.count = 0;
    if (size_over_distance > 0) {
        if (source_.is_flat()) {
            const Vec3 to_center = point - source_.center;
            if (!(dot(to_center, source_.normal) > 0)) return;
            if (!is_far(to_center, size_over_distance)) {
                const double scale = 2 / size_over_distance;
                FlatPartition(source_, to_center, scale * length(source_.u),
                              scale * length(source_.v), parts);
                return;
            }
        } else if (source_.is_cylinder()) {
            CylinderPartition(source_, point, size_over_distance, parts);
            return;
        }
    }
    parts.part[0] = kWholeBox;
    parts.count = 1;
}

}  // namespace lightwalk
