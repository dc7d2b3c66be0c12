#include "core/light/small_sources.h"

#include <algorithm>
#include <cmath>

#include "core/transport/light_groups.h"

namespace lightwalk {
namespace {

constexpr float kWidestDistant =
    0.05f;  ///< effective radius of sources at infinity that are never missed [rad]
constexpr float kAlreadyShown = 0.07f;  ///< relative difference of a pixel that shows the source
constexpr double kClearlyNearer = 0.99;

bool alike(const Rgb& pixel, const Rgb& source) {
    for (std::size_t i = 0; i < 3; ++i) {
        const float a = pixel[i], b = source[i];
        if (a - b > kAlreadyShown * b || b - a > kAlreadyShown * a) return false;
    }
    return true;
}

bool reaches(const Ray& ray) {
    return static_cast<double>(max_component(ray.value)) > kEpsilon;
}

}  // namespace

SourceBlend blend_source(const SourcePixel& source, Rgb& pixel, float* distance) {
    const float w = source.coverage;
    const bool nearer =
        distance && source.distance < kClearlyNearer * static_cast<double>(*distance);
    if (nearer) *distance = static_cast<float>(source.distance);
    const bool shown = source.shown == ShownSource::yes ||
                       (source.shown == ShownSource::by_colour && alike(pixel, source.radiance));
    if (!nearer && shown) {
        pixel *= w;
        return {w, 0};
    }
    pixel = pixel * (1 - w) + source.radiance * w;
    return {1 - w, w};
}

SmallSources::SmallSources(const LightTransport& tracer, const Camera& camera, int width,
                           int height, int spacing, const PixelRays* rays, bool own_only)
    : tracer_(tracer),
      camera_(camera),
      width_(width),
      height_(height),
      rays_(rays),
      own_only_(own_only && spacing == 1) {
    if (!tracer.options().sources_visible) return;
    const double y_scale = camera.aspect() * width / height;
    const std::span<const LightSource> sources = tracer.lights().all();
    for (std::size_t i = 0; i < sources.size(); ++i) {
        Outline outline;
        outline.source = static_cast<std::int32_t>(i);
        if (sources[i].material_type == PrimitiveType::illum ||
            !project(sources[i], outline.polygon))
            continue;
        if (outline.polygon.width(y_scale) <= spacing) outlines_.push_back(outline);
    }
}

bool SmallSources::add_corner(const Vec3& corner, ImagePolygon& polygon) const {
    const Camera::ImagePosition at = camera_.locate(corner);
    if (!at.visible()) return false;
    polygon.add({at.h * width_, at.v * height_});
    return true;
}

bool SmallSources::project(const LightSource& source, ImagePolygon& polygon) const {
    if (source.is_distant()) {
        if (camera_.view().type == 'l' || source.radius >= kWidestDistant) return false;
        return project_parallelogram(source, polygon);
    }
    if (!source.is_flat()) return project_box(source, polygon);
    if (dot(source.center - camera_.view().position, source.normal) >= 0) return false;
    return project_parallelogram(source, polygon);
}

bool SmallSources::project_parallelogram(const LightSource& source, ImagePolygon& polygon) const {
    const View& view = camera_.view();
    for (const auto& [u, v] :
         {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
        Vec3 corner = source.center + source.u * u + source.v * v;
        if (source.is_distant()) corner = view.position + corner * (1 + view.fore);
        if (!add_corner(corner, polygon)) return false;
    }
    return true;
}

/// The six corners of the sampling box between the nearest and the farthest one.
bool SmallSources::project_box(const LightSource& source, ImagePolygon& polygon) const {
    const View& view = camera_.view();
    const Vec3 to_eye = view.type == 'l' ? -camera_.forward() : view.position - source.center;
    const auto towards_eye = [&](const Vec3& axis) { return dot(axis, to_eye) > 0 ? axis : -axis; };
    const Vec3 u = towards_eye(source.u), v = towards_eye(source.v), w = towards_eye(source.w);
    const Vec3 c = source.center;
    for (const Vec3& corner : {c - u + v + w, c - u - v + w, c + u - v + w, c + u - v - w,
                               c + u + v - w, c - u + v - w}) {
        if (!add_corner(corner, polygon)) return false;
    }
    polygon.make_convex();
    return true;
}

void SmallSources::draw(const PixelRectangle& area, TraceContext& context,
                        FunctionRef<void(const SourcePixel&)> pixel) const {
    for (const Outline& outline : outlines_) {
        double x0 = width_, x1 = 0, y0 = height_, y1 = 0;
        for (std::size_t i = 0; i < outline.polygon.size(); ++i) {
            x0 = std::min(x0, outline.polygon[i].x);
            x1 = std::max(x1, outline.polygon[i].x);
            y0 = std::min(y0, outline.polygon[i].y);
            y1 = std::max(y1, outline.polygon[i].y);
        }
        const int first_x = std::max(area.x0, static_cast<int>(x0)),
                  first_y = std::max(area.y0, static_cast<int>(y0));
        const int last_x = std::min(area.x1 - 1, static_cast<int>(x1));
        const int last_y = std::min({area.y1 - 1, static_cast<int>(y1), height_ - 2});
        for (int y = first_y; y <= last_y; ++y) {
            for (int x = first_x; x <= last_x; ++x) draw_pixel(outline, x, y, context, pixel);
        }
    }
}

void SmallSources::draw_pixel(const Outline& outline, int x, int y, TraceContext& context,
                              FunctionRef<void(const SourcePixel&)> pixel) const {
    const ImagePolygon inside = outline.polygon.clip_to_cell(x, y);
    const double coverage = inside.area();
    if (!(coverage > 0)) return;
    const ImagePoint center = inside.center();
    const ShownSource shown = this->shown(outline.source, x, y, context);
    const Ray ray = trace_to(outline.source, x, y, center.x / width_, center.y / height_, context);
    if (reaches(ray))
        pixel({x, y, static_cast<float>(coverage), ray.value, ray.unreflected_path_length, shown});
}

/// Black where the source does not send light along this ray, or something is in its way.
/// @param h, v  image position, see Camera::ray
Ray SmallSources::trace_to(std::int32_t source, int x, int y, double h, double v,
                           TraceContext& context) const {
    const auto view_ray = camera_.ray(h, v);
    if (!view_ray) return {};
    if (!tracer_.lights().inside_spot(tracer_.lights()[source], view_ray->origin,
                                      view_ray->direction))
        return {};
    const auto stream = 0x80000000U + static_cast<std::uint32_t>(source);
    Ray ray = tracer_.primary(
        view_ray->origin, view_ray->direction, view_ray->limit,
        RandomStream::of_pixel(tracer_.options().seed, static_cast<std::uint32_t>(x),
                               static_cast<std::uint32_t>(y), stream));
    ray.kind = kShadow;
    ray.history = kShadow;
    ray.target = source;
    ++context.counters.rays.shadow;
    if (context.groups) context.groups->clear();
    tracer_.trace(ray, context);
    return ray;
}

ShownSource SmallSources::shown(std::int32_t source, int x, int y, TraceContext& context) const {
    if (rays_ == nullptr) return ShownSource::by_colour;
    const PixelRays::Place own = rays_->place(x, y);
    if (!reaches(trace_to(source, x, y, own.h, own.v, context))) return ShownSource::no;
    return own_only_ ? ShownSource::yes : ShownSource::by_colour;
}

}  // namespace lightwalk
