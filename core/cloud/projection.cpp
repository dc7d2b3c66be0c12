#include "core/cloud/projection.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cloud/point_order.h"

namespace lightwalk {
namespace {

/// Number of points projected together, so that the cells of the grids are prefetched.
constexpr std::size_t kAtOnce = 64;

}  // namespace

PointProjector::PointProjector(const Camera& camera, int width, int height)
    : camera_(camera), width_(width), height_(height), perspective_(camera.view().type == 'v') {
    if (!perspective_) return;
    // The scale of the picture follows from the projection of points at depth 1.
    const Vec3 axis = camera.view().position + camera.forward();
    const Camera::ImagePosition centre = camera.locate(axis);
    const Camera::ImagePosition right = camera.locate(axis + camera.right());
    const Camera::ImagePosition upper = camera.locate(axis + camera.upward());
    across_ = camera.right() * ((right.h - centre.h) * width);
    upward_ = camera.upward() * ((upper.v - centre.v) * height);
    forward_ = camera.forward();
    shift_ = centre.h * width;
    lift_ = centre.v * height;
    eye_ = camera.view().position;
    fore_ = camera.view().fore;
    nearest_ = std::max(fore_, kEpsilon);
    if (camera.view().aft > kEpsilon) farthest_ = camera.view().aft;
}

/// Without branches, so that compilers vectorise it.
inline ImagePlace PointProjector::in_perspective(const Vec3& point) const {
    const Vec3 w = point - eye_;
    const double depth = dot(w, forward_), scale = 1 / depth;
    const double x = dot(w, across_) * scale + shift_, y = dot(w, upward_) * scale + lift_;
    const double distance = length(w) * (1 - fore_ * scale);
    const bool shown = (depth > nearest_) & (depth < farthest_) & (x >= 0) & (x < width_) &
                       (y >= 0) & (y < height_);
    return {shown ? static_cast<float>(x) : -1.0f, shown ? static_cast<float>(y) : -1.0f,
            shown ? static_cast<float>(distance) : 0.0f};
}

/// Not where all corners of the box lie beyond one side of the view's pyramid.
bool PointProjector::may_show(const Vec3& lower, const Vec3& upper) const {
    if (!perspective_) return true;
    constexpr unsigned kSides = 5;
    unsigned beyond = (1u << kSides) - 1;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 w =
            Vec3{(corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                 (corner & 4) != 0 ? upper.z : lower.z} -
            eye_;
        const double depth = dot(w, forward_);
        const double x = dot(w, across_) + shift_ * depth, y = dot(w, upward_) + lift_ * depth;
        beyond &= (depth <= nearest_ ? 1u : 0u) | (x < 0 ? 2u : 0u) |
                  (x > width_ * depth ? 4u : 0u) | (y < 0 ? 8u : 0u) |
                  (y > height_ * depth ? 16u : 0u);
    }
    return beyond == 0;
}

ImagePlace PointProjector::operator()(const Vec3& point) const {
    if (perspective_) return in_perspective(point);
    const Camera::ImagePosition at = camera_.locate(point);
    if (!at.visible()) return {};
    return {static_cast<float>(at.h * width_), static_cast<float>(at.v * height_),
            static_cast<float>(at.distance)};
}

void PointProjector::operator()(std::span<const CloudPoint> points,
                                std::span<ImagePlace> places) const {
    if (!perspective_) {
        for (std::size_t i = 0; i < points.size(); ++i)
            places[i] =
                points[i].kind == PointKind::gone ? ImagePlace{} : (*this)(points[i].place());
        return;
    }
    std::array<double, kAtOnce> x, y, z;
    std::array<float, kAtOnce> across, up, distance;
    for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, points.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 place = points[first + i].place();
            x[i] = place.x;
            y[i] = place.y;
            z[i] = place.z;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const ImagePlace place = in_perspective({x[i], y[i], z[i]});
            across[i] = place.x;
            up[i] = place.y;
            distance[i] = place.distance;
        }
        for (std::size_t i = 0; i < count; ++i)
            places[first + i] = points[first + i].kind == PointKind::gone
                                    ? ImagePlace{}
                                    : ImagePlace{across[i], up[i], distance[i]};
    }
}

void project_points(const PointProjector& projector, std::span<const CloudPoint> points,
                    std::size_t first, std::size_t last, CloudGrids& grids,
                    std::span<ImagePlace> places) {
    const auto earlier = [&](std::uint32_t a, std::uint32_t b) {
        return precedes(points[a], points[b]);
    };
    std::array<std::uint32_t, kAtOnce> shown;
    std::array<PixelPlace, kAtOnce> pixels;
    for (std::size_t begin = first; begin < last; begin += kAtOnce) {
        const std::size_t end = std::min(begin + kAtOnce, last);
        projector(points.subspan(begin, end - begin), places.subspan(begin, end - begin));
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const PixelPlace pixel = pixel_of(places[i], projector.width(), projector.height());
            if (!(places[i].distance > 0) || !grids.ahead.area().contains(pixel)) continue;
            grids.of(points[i].kind).prefetch(pixel.x, pixel.y);
            pixels[count] = pixel;
            shown[count++] = static_cast<std::uint32_t>(i);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const PixelPlace& pixel = pixels[k];
            const ImagePlace& place = places[shown[k]];
            const float dx = place.x - (static_cast<float>(pixel.x) + 0.5f);
            const float dy = place.y - (static_cast<float>(pixel.y) + 0.5f);
            const float apart = std::min(std::sqrt(dx * dx + dy * dy), 1.0f);
            grids.of(points[shown[k]].kind)
                .offer(pixel.x, pixel.y, place.distance, apart, shown[k], earlier);
        }
    }
}

}  // namespace lightwalk
