#include "core/light/emission.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr int kDirections = 16;
constexpr float kLeastShare =
    1.0f / 16;  ///< of the material's brightness, where patterns look dark
constexpr double kGoldenTurn = 0.6180339887498949;
constexpr double kDistance = 4;  ///< from which a source is looked at, over its radius

/// What is wrong with a pattern is told when a picture needs it.
class NoWarnings final : public WarningSink {
  public:
    void warn(const std::string&) override {}
};

/// Brightness of what the source sends to `place` against `direction`.
float brightness_at(const Vec3& place, const Vec3& direction, std::int32_t source,
                    TraceContext& context) {
    Ray parent = context.tracer.primary(place - direction, direction, 0, RandomStream());
    parent.hit.position = place;
    parent.hit.t = 1;
    Ray ray;
    (void)context.tracer.spawn(ray, kShadow, parent, nullptr);
    ray.aimed = true;
    ray.direction = direction;
    ray.target = source;
    context.tracer.trace(ray, context);
    const float b = brightness(ray.value);
    return std::isfinite(b) ? std::max(0.0f, b) : 0;
}

/// Directions away from a source: by the cosine over the front of flat ones, else all alike. Spiral
/// of golden angles: Vogel, "A better way to construct the sunflower head", 1979.
Vec3 direction_from(const LightSource& source, int i) {
    const double share = (i + 0.5) / kDirections, turn = 2 * kPi * kGoldenTurn * i;
    const Vec3 z = source.is_flat() ? source.normal : Vec3{0, 0, 1};
    const Vec3 x = perpendicular(z), y = cross(z, x);
    const double height = source.is_flat() ? std::sqrt(1 - share) : 1 - 2 * share;
    const double r = std::sqrt(1 - height * height);
    return x * (r * std::cos(turn)) + y * (r * std::sin(turn)) + z * height;
}

float mean_emission(const LightSource& source, std::int32_t index, TraceContext& context) {
    const float plain = brightness(source.radiance);
    if (source.uniform) return plain;
    float mean = 0;
    if (source.is_distant()) {
        const SceneCube& cube = context.tracer.scene().cube();
        const Vec3 middle = cube.origin + Vec3{1, 1, 1} * (0.5 * cube.size);
        mean = brightness_at(middle, source.center, index, context);
    } else {
        for (int i = 0; i < kDirections; ++i) {
            const Vec3 away = direction_from(source, i);
            const Vec3 place =
                source.center + away * (kDistance * static_cast<double>(source.radius));
            mean += brightness_at(place, -away, index, context) / kDirections;
        }
    }
    return std::max(mean, kLeastShare * plain);
}

}  // namespace

std::vector<float> mean_emissions(const LightSources& lights, const LightTransport& tracer) {
    NoWarnings warnings;
    TraceContext context(tracer, warnings);
    std::vector<float> emissions(lights.all().size());
    for (std::size_t i = 0; i < emissions.size(); ++i) {
        const LightSource& source = lights.all()[i];
        if (source.is_virtual() || source.unusable) continue;
        emissions[i] = mean_emission(source, static_cast<std::int32_t>(i), context);
    }
    return emissions;
}

}  // namespace lightwalk
