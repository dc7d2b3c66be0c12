#include "core/glare/outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/glare/pixel_contour.h"
#include "core/glare/visual_field.h"

namespace lightwalk {
namespace {

constexpr double kLongestStep = 5 * kPi / 180;  ///< between points of a curved edge [rad]
constexpr double kBesideEye =
    0.02;  ///< directions with a smaller cosine to the view axis are cut off in a perspective [1]

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// The angle between `p` and the shorter arc from `a` to `b` [rad].
double angle_to_arc(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 pole = normalize(cross(a, b));  // zero where the points coincide or are antipodes
    const bool beside = dot(cross(pole, a), p) > 0 && dot(cross(b, pole), p) > 0;
    if (beside) return std::abs(std::asin(std::clamp(dot(pole, p), -1., 1.)));
    return std::min(angle_between(p, a), angle_between(p, b));
}

/// Marks the points that a curve needs between `first` and `last` so that none is farther than
/// `tolerance` from it; always at least one, so that a thin source does not become a line. Source:
/// Douglas & Peucker, "Algorithms for the reduction of the number of points required to represent a
/// digitized line", Cartographica 10 (1973), with arcs for lines.
void mark_needed(std::span<const Vec3> curve, std::size_t first, std::size_t last, double tolerance,
                 std::vector<bool>& needed) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
    double allowed = -1;
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        std::size_t farthest = from;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double off = angle_to_arc(curve[i], curve[from], curve[to]);
            if (off > allowed) allowed = off, farthest = i;
        }
        allowed = tolerance;
        if (farthest == from) continue;
        needed[farthest] = true;
        open.emplace_back(from, farthest);
        open.emplace_back(farthest, to);
    }
}

/// A closed curve with fewer points, at least 4, all within `tolerance` [rad] of it.
/// @param loop  the curve, its first point repeated at the end
std::vector<Vec3> simplified(const std::vector<Vec3>& loop, double tolerance) {
    std::size_t opposite = 0;
    double largest = -1;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const double angle = angle_between(loop[0], loop[i]);
        if (angle > largest) largest = angle, opposite = i;
    }
    std::vector<bool> needed(loop.size(), false);
    needed[0] = needed[opposite] = true;
    mark_needed(loop, 0, opposite, tolerance, needed);
    mark_needed(loop, opposite, loop.size() - 1, tolerance, needed);
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
        if (needed[i]) kept.push_back(loop[i]);
    }
    return kept;
}

/// The size of the contour's steps, as the length of a typical one [rad].
double typical_step(const std::vector<Vec3>& loop) {
    double sum = 0;
    for (std::size_t i = 1; i < loop.size(); ++i) sum += angle_between(loop[i - 1], loop[i]);
    return sum / static_cast<double>(loop.size() - 1);
}

/// How far an outline may run beside a contour of so many steps [steps]: enough to make a straight
/// line of the stairs along a window's edge, which are up to sqrt(2) steps high; less for small
/// sources, whose shape would be lost.
double smoothing(std::size_t steps) {
    return std::clamp(static_cast<double>(steps) / 200, 0.75, 1.6);
}

/// The part of a closed polygon for which dot(direction, axis) >= least: Sutherland & Hodgman,
/// "Reentrant polygon clipping", Communications of the ACM 17 (1974).
std::vector<Vec3> clipped(std::span<const Vec3> polygon, const Vec3& axis, double least) {
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double inside_from = dot(from, axis) - least, inside_to = dot(to, axis) - least;
        if (inside_from >= 0) kept.push_back(from);
        if ((inside_from >= 0) != (inside_to >= 0)) {
            const double t = inside_from / (inside_from - inside_to);
            kept.push_back(from + t * (to - from));
        }
    }
    return kept;
}

/// A closed polygon with points on its longer arcs.
std::vector<Vec3> subdivided(std::span<const Vec3> polygon) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double angle = angle_between(from, to);
        const int steps = std::max(1, static_cast<int>(std::ceil(angle / kLongestStep)));
        for (int k = 0; k < steps; ++k) {
            const double t = 1. * k / steps;
            points.push_back(
                k == 0 ? from
                       : normalize(std::sin((1 - t) * angle) * from + std::sin(t * angle) * to));
        }
    }
    return points;
}

/// The view moved to the origin, without clipping surfaces, for projecting directions.
Camera directions_only(View view) {
    view.position = {};
    view.fore = view.aft = 0;
    return Camera(view);
}

}  // namespace

std::vector<Vec3> outline_of(std::span<const PixelPlace> places, const Camera& camera, int width,
                             int height, std::size_t limit) {
    std::vector<Vec3> loop;
    for (const PixelPlace& corner : pixel_contour(places))
        loop.push_back(field_direction(camera, 1. * corner.x / width, 1. * corner.y / height));
    if (loop.empty()) return {};
    loop.push_back(loop.front());

    const double step = typical_step(loop);
    double tolerance = smoothing(loop.size()) * step;
    std::vector<Vec3> outline = simplified(loop, tolerance);
    while (outline.size() > limit) outline = simplified(loop, tolerance *= 1.25);
    return outline;
}

std::vector<OutlinePoint> project_outline(std::span<const Vec3> outline, const Camera& camera) {
    const char type = camera.view().type;
    if (type == 'l') return {};
    std::vector<Vec3> shown(outline.begin(), outline.end());
    if (type != 'v') shown = subdivided(shown);
    if (type == 'v' || type == 'h')
        shown = clipped(shown, camera.forward(), type == 'v' ? kBesideEye : 0);
    const Camera plain = directions_only(camera.view());
    std::vector<OutlinePoint> points;
    for (const Vec3& direction : shown) {
        const Camera::ImagePosition at = plain.locate(direction);
        if (at.in_front) points.push_back({at.h, at.v});
    }
    return points;
}

}  // namespace lightwalk
