// Pretest of virtual sources (-dp): which of them light can reach, and which need no test of their
// redirected path.
#include <cmath>

#include "core/light/partition.h"
#include "core/virtual_source/virtual_sources.h"

namespace lightwalk {
namespace {

constexpr int kLeastSamples = 16;
constexpr int kMaxSamples = 1 << 16;
constexpr int kDrawsPerSample =
    32;  ///< attempts for each sample to find a point on the redirecting surface

/// A point uniformly distributed in the disk, in the plane with this normal.
Vec3 point_in_disk(const RedirectingDisk& disk, const Vec3& normal, RandomStream& random) {
    const Vec3 u = perpendicular(normal), v = cross(normal, u);
    const double radius = disk.radius * std::sqrt(random.next()), angle = 2 * kPi * random.next();
    return disk.center + u * (radius * std::cos(angle)) + v * (radius * std::sin(angle));
}

}  // namespace

/// Number of samples by -dp: per solid angle of the redirecting surface as seen from the parent
/// source; for distant sources, of the whole scene.
int VirtualSourceBuilder::pretest_samples(const LightSource& parent,
                                          const RedirectingDisk& disk) const {
    const double density = tracer_.options().virtual_source_pretest,
                 radius_squared = disk.radius * disk.radius;
    double samples = 0;
    if (parent.is_distant()) {
        const double size = tracer_.scene().cube().size;
        samples = size > 0 ? 32 * radius_squared / (size * size) * density : 0;
    } else {
        const double distance_squared = length_squared(disk.center - parent.center);
        const double cosine =
            distance_squared > 0 ? std::sqrt(1 / (1 + radius_squared / distance_squared)) : 0;
        samples = 2 * kPi * (1 - cosine) * density;
    }
    return static_cast<int>(std::clamp(samples + 0.5, static_cast<double>(kLeastSamples),
                                       static_cast<double>(kMaxSamples)));
}

/// Brightness of the light that a source sends to a point, through the scene or (`alone`) without
/// other surfaces.
float VirtualSourceBuilder::light_at(const Vec3& point, const Vec3& direction, std::int32_t source,
                                     bool alone) {
    Ray at_point = tracer_.primary(point, direction, 0, RandomStream(tracer_.options().seed));
    at_point.hit.t = 0;
    at_point.hit.position = point;
    Ray to_source;
    (void)tracer_.spawn(to_source, kShadow, at_point, nullptr);
    to_source.direction = direction;
    to_source.target = source;
    to_source.aimed = alone;
    tracer_.trace(to_source, context_);
    return brightness(to_source.value);
}

VirtualSourceBuilder::Pretest VirtualSourceBuilder::pretest(std::int32_t parent_index,
                                                            const RedirectingSurface& next,
                                                            const RedirectingDisk& disk) {
    const LightSource parent = lights_[parent_index];
    const RenderOptions& options = tracer_.options();
    const int wanted = pretest_samples(parent, disk);
    RandomStream random(mix_bits(options.seed ^ mix_bits(static_cast<std::uint64_t>(parent_index)) ^
                                 static_cast<std::uint64_t>(index(next.surface))));
    int found = 0, lit = 0, agreed = 0;
    for (int draw = 0; found < wanted; ++draw) {
        if (draw >= kDrawsPerSample * wanted) return Pretest::follow;  // too small to be sampled
        // Any ray onto the redirecting surface will do to find out whether the point is within its
        // outline.
        const Vec3 above = point_in_disk(disk, next.plane.normal, random) + next.plane.normal;
        const Vec3 point = above - next.plane.normal * next.plane.height(above);
        if (!tracer_.scene()
                 .geometry()
                 .intersect_surface(next.surface, {above, -next.plane.normal, kHuge})
                 .exists()) {
            continue;
        }
        ++found;
        const auto sample = sample_whole(parent, point, options.source_jitter, random);
        const bool alone = sample && light_at(point, sample->direction, parent_index, true) > 0;
        const bool in_scene = alone && light_at(point, sample->direction, parent_index, false) > 0;
        lit += in_scene ? 1 : 0;
        agreed += alone == in_scene ? 1 : 0;
    }
    if (lit == 0) return Pretest::discard;
    return agreed == found ? Pretest::direct : Pretest::follow;
}

}  // namespace lightwalk
