#include "core/light/light_walk.h"

#include <cmath>

#include "core/light/source_setup.h"

namespace lightwalk {
namespace {

constexpr int kBounces = 3;
constexpr int kMaxCrossings = 16;  ///< of transparent surfaces, between two bounces

class LightWalk {
  public:
    explicit LightWalk(const LightTransport& tracer)
        : scene_(tracer.scene()),
          seed_(tracer.options().seed),
          bounds_(scene_.geometry().bounds()) {}

    void walk(std::uint64_t number, const LightSource& source, std::vector<Hit>& places) {
        random_ = RandomStream(mix_bits(seed_ + 0x77616c6bULL) ^ mix_bits(number));
        RaySegment ray = emit(source);
        for (int bounce = 0; bounce < kBounces; ++bounce) {
            Hit hit = opaque_hit(ray);
            if (!hit.exists()) return;
            if (hit.cos_out < 0) {
                hit.normal = -hit.normal;
                hit.cos_out = -hit.cos_out;
            }
            places.push_back(hit);
            ray = {hit.position, about(hit.normal, std::sqrt(1 - random_.next())), kHuge};
        }
    }

  private:
    /// A random unit vector at an angle of this cosine to the axis.
    Vec3 about(const Vec3& axis, double cosine) {
        const Vec3 u = perpendicular(axis), v = cross(axis, u);
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)),
                     azimuth = 2 * kPi * random_.next();
        return axis * cosine + (u * std::cos(azimuth) + v * std::sin(azimuth)) * sine;
    }

    RaySegment emit(const LightSource& source) {
        if (source.is_distant()) {
            // Parallel light through the bounding sphere.
            const Vec3 center = (bounds_.lower + bounds_.upper) * 0.5;
            const double radius = 0.5 * length(bounds_.upper - bounds_.lower);
            const Vec3 across = about(source.center, 0) * (radius * std::sqrt(random_.next()));
            return {center + across + source.center * (2 * radius), -source.center, kHuge};
        }
        const Vec3 start = source.center + source.u * (1 - 2 * random_.next()) +
                           source.v * (1 - 2 * random_.next());
        if (source.is_flat())
            return {start, about(source.normal, std::sqrt(1 - random_.next())), kHuge};
        return {start, about({0, 0, 1}, 1 - 2 * random_.next()), kHuge};
    }

    [[nodiscard]] bool lets_light_through(const Hit& hit) const {
        const auto material = scene_.material_of(hit.modifier);
        return !material || scene_.is_transparent(hit.modifier) ||
               is_light(scene_.modifier(*material).type);
    }

    [[nodiscard]] Hit opaque_hit(RaySegment ray) const {
        for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
            const Hit hit = scene_.geometry().intersect(ray);
            if (!hit.exists() || !lets_light_through(hit)) return hit;
            ray.origin = hit.position;
        }
        return {};
    }

    const Scene& scene_;
    std::uint64_t seed_;
    Bounds bounds_;
    RandomStream random_;
};

}  // namespace

std::vector<Hit> walk_light(const LightSources& lights, const LightTransport& tracer,
                            std::size_t wanted) {
    std::vector<std::int32_t> emitters;
    for (const std::int32_t i : lights.sampled()) {
        if (!lights[i].is_virtual()) emitters.push_back(i);
    }
    std::vector<Hit> places;
    if (emitters.empty() || tracer.scene().geometry().bounds().empty()) return places;
    LightWalk light(tracer);
    for (std::uint64_t number = 0; number < wanted && places.size() < wanted; ++number) {
        light.walk(number, lights[emitters[number % emitters.size()]], places);
    }
    return places;
}

}  // namespace lightwalk
