#include "apps/walk/walk_answers.h"

#include <algorithm>
#include <cmath>

#include "core/math/distance.h"
#include "core/math/xyz.h"
#include "core/scene/scene.h"

namespace lightwalk {
namespace {

constexpr int kPixelRays = 4;  // rays along each side of a pixel

double luminance(const Rgb& radiance) {
    return double{kEfficacy} * static_cast<double>(brightness(radiance));
}

}  // namespace

WalkAnswers::WalkAnswers(const Tracer& tracer, WarningSink& warnings,
                         std::shared_ptr<const LightGroups> groups)
    : tracer_(tracer), context_(tracer, warnings) {
    if (!groups) return;
    sums_ = std::make_unique<GroupSums>(std::move(groups));
    context_.contributions = context_.groups = sums_.get();
}

/// A ray's value, and what was told of it.
void WalkAnswers::add(const Rgb& value, Light& sum) const {
    sum.whole += value;
    if (!sums_) return;
    sum.groups.resize(sums_->size());
    for (std::size_t g = 0; g < sums_->size(); ++g) sum.groups[g] += sums_->sums()[g];
    sums_->clear();
}

double WalkAnswers::shown(const Light& light) const {
    return luminance(sums_ ? mixture_(light.whole, light.groups) : light.whole);
}

void WalkAnswers::look(const Vec3& origin, const Vec3& direction, double limit, int sample,
                       Light& sum) {
    Ray ray = tracer_.primary(origin, direction, limit,
                              RandomStream::of_pixel(0, 0, 0, static_cast<std::uint32_t>(sample)));
    if (sums_) sums_->clear();
    tracer_.trace(ray, context_);
    add(ray.value, sum);
}

WalkAnswers::Light WalkAnswers::falling(const Vec3& point, const Vec3& normal) {
    constexpr int kRays = 16;
    Light light;
    if (sums_) sums_->clear();
    for (int i = 0; i < kRays; ++i)
        add(tracer_
                .irradiance(point, normal,
                            RandomStream::of_pixel(1, 0, 0, static_cast<std::uint32_t>(i)),
                            context_)
                .value,
            light);
    light.scale(1.0f / kRays);
    return light;
}

PickedReply WalkAnswers::pick(const PickRequest& request, const Camera& camera,
                              const std::pair<double, double>& pixel) {
    PickedReply reply;
    reply.id = request.id;
    const std::optional<Camera::ViewRay> middle = camera.ray(request.x, request.y);
    if (!middle) return reply;
    Light seen;
    int rays = 0;
    for (int k = 0; k < kPixelRays * kPixelRays; ++k) {
        const int column = k % kPixelRays, row = k / kPixelRays;
        const double h = request.x + ((column + 0.5) / kPixelRays - 0.5) * pixel.first;
        const double v = request.y + ((row + 0.5) / kPixelRays - 0.5) * pixel.second;
        const std::optional<Camera::ViewRay> ray = camera.ray(h, v);
        if (!ray) continue;
        look(ray->origin, ray->direction, ray->limit, k, seen);
        ++rays;
    }
    seen.scale(1.0f / static_cast<float>(std::max(rays, 1)));
    reply.luminance = shown(seen);
    const Scene& scene = tracer_.scene();
    const Hit hit = scene.geometry().intersect(
        {middle->origin, middle->direction, farthest_hit(middle->limit)});
    reply.hit = hit.exists();
    if (!reply.hit) return reply;
    reply.distance = hit.t;
    reply.position = hit.position;
    reply.normal = dot(hit.normal, middle->direction) > 0 ? -hit.normal : hit.normal;
    reply.illuminance = shown(falling(reply.position, reply.normal));
    const std::optional<ModifierId> material = scene.material_of(hit.modifier);
    reply.material = material ? scene.modifier(*material).name : "void";
    reply.surface = scene.surface(hit.surface).name();
    return reply;
}

MeanReply WalkAnswers::mean(const MeanRequest& request, const LivePicture& picture) {
    const auto pixels = [](double from, double to, int size) {
        const int first = std::clamp(static_cast<int>(std::floor(from * size)), 0, size - 1);
        const int last = std::clamp(static_cast<int>(std::ceil(to * size)), first + 1, size);
        return std::pair{first, last};
    };
    const auto [x0, x1] = pixels(request.x0, request.x1, picture.width);
    const auto [y0, y1] = pixels(1 - request.y1, 1 - request.y0, picture.height);
    double sum = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            sum += luminance(picture.radiance[static_cast<std::size_t>(y) *
                                                  static_cast<std::size_t>(picture.width) +
                                              static_cast<std::size_t>(x)]);
    const auto count = static_cast<std::uint64_t>(x1 - x0) * static_cast<std::uint64_t>(y1 - y0);
    return {request.id, sum / static_cast<double>(count), count};
}

ProbeValue WalkAnswers::measure(const ProbePlace& probe, const Vec3& eye) {
    Measured measured{probe.position, probe.normal, falling(probe.position, probe.normal), {}};
    const Vec3 way = probe.position - eye;
    constexpr double kBeyond = 1.001;  // so that the ray reaches the pin's surface
    const double far = length(way);
    if (far > kEpsilon) look(eye, way * (1 / far), kBeyond * far, 0, measured.seen);
    const ProbeValue value{probe.id, shown(measured.falling), shown(measured.seen)};
    if (measured_.size() > kMostProbes) measured_.clear();  // of pins that are gone
    if (sums_) measured_.insert_or_assign(probe.id, std::move(measured));
    return value;
}

std::optional<ProbeValue> WalkAnswers::mixed(const ProbePlace& probe) const {
    const auto found = measured_.find(probe.id);
    if (found == measured_.end() || found->second.position != probe.position ||
        found->second.normal != probe.normal)
        return std::nullopt;
    return ProbeValue{probe.id, shown(found->second.falling), shown(found->second.seen)};
}

std::optional<double> height_above_ground(const Geometry& geometry, const Vec3& eye,
                                          const Vec3& up) {
    const Hit below = geometry.intersect({eye, -normalize(up), kHuge});
    return below.exists() ? std::optional(below.t) : std::nullopt;
}

}  // namespace lightwalk
