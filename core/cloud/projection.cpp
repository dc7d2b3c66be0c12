#include "core/cloud/projection.h"

#include <algorithm>
#include <cmath>

#include "core/cloud/point_order.h"

namespace lightwalk {

PointProjector::PointProjector(const Camera& camera, int width, int height)
    : camera_(camera), width_(width), height_(height), perspective_(camera.view().type == 'v') {
    if (!perspective_) return;
    // A point at depth 1 on the right edge's side of the axis tells the scale of the picture.
    const Vec3 axis = camera.view().position + camera.forward();
    const Camera::ImagePosition centre = camera.locate(axis);
    const Camera::ImagePosition right = camera.locate(axis + camera.right());
    const Camera::ImagePosition upper = camera.locate(axis + camera.upward());
    across_ = camera.right() * ((right.h - centre.h) * width);
    upward_ = camera.upward() * ((upper.v - centre.v) * height);
    forward_ = camera.forward();
    shift_ = centre.h * width;
    lift_ = centre.v * height;
}

ImagePlace PointProjector::in_perspective(const Vec3& point) const {
    const View& view = camera_.view();
    const Vec3 w = point - view.position;
    const double depth = dot(w, forward_);
    if (!(depth > std::max(view.fore, kEpsilon))) return {};
    if (view.aft > kEpsilon && depth >= view.aft) return {};
    const double scale = 1 / depth;
    const double x = dot(w, across_) * scale + shift_, y = dot(w, upward_) * scale + lift_;
    if (!(x >= 0 && x < width_ && y >= 0 && y < height_)) return {};
    return {static_cast<float>(x), static_cast<float>(y),
            static_cast<float>(length(w) * (1 - view.fore * scale))};
}

ImagePlace PointProjector::operator()(const Vec3& point) const {
    if (perspective_) return in_perspective(point);
    const Camera::ImagePosition at = camera_.locate(point);
    if (!at.visible()) return {};
    return {static_cast<float>(at.h * width_), static_cast<float>(at.v * height_),
            static_cast<float>(at.distance)};
}

void project_points(const PointProjector& projector, std::span<const CloudPoint> points,
                    std::size_t first, std::size_t last, CloudGrids& grids,
                    std::span<ImagePlace> places) {
    for (std::size_t i = first; i < last; ++i) {
        const CloudPoint& point = points[i];
        const ImagePlace place =
            point.kind == PointKind::gone ? ImagePlace{} : projector(point.place());
        places[i] = place;
        if (!(place.distance > 0)) continue;
        const PixelPlace pixel = pixel_of(place, projector.width(), projector.height());
        if (!grids.ahead.area().contains(pixel)) continue;
        const float dx = place.x - (static_cast<float>(pixel.x) + 0.5f);
        const float dy = place.y - (static_cast<float>(pixel.y) + 0.5f);
        const float apart = std::min(std::sqrt(dx * dx + dy * dy), 1.0f);
        DepthGrid& grid = point.kind == PointKind::mirrored ? grids.mirrored : grids.ahead;
        grid.offer(
            pixel.x, pixel.y, place.distance, apart, static_cast<std::uint32_t>(i),
            [&](std::uint32_t a, std::uint32_t b) { return precedes(points[a], points[b]); });
    }
}

}  // namespace lightwalk
