#include "core/material/bsdf_hit.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/bsdf/bsdf_color.h"
#include "core/material/rough_samples.h"

namespace lightwalk {
namespace {

/// Of numbers that -ss below 1 narrows. Beside the very middle, where patches of another basis
/// meet.
constexpr double kMiddle = 0.5 + 1e-9;
constexpr int kNear = static_cast<int>(kNearDirections);
constexpr double kSmallestNeighbour = 0.12;  ///< smaller cells do not count in a cell's mean

/// What is sampled of a component, or why not.
struct SampledComponent {
    const BsdfComponent* component;
    RayKind kind;
    double side;   ///< of its light, see BsdfHit
    bool through;  ///< transmission
};

/// The directional-hemispherical total about the hit's direction that samples would carry.
double sampled_total(Ray& ray, const BsdfHit& hit, const SampledComponent& sampled,
                     double specular_samples) {
    const double size = std::sqrt(hit.resolution.largest);
    const ProjectedDirection e = jittered(hit, size, specular_samples, ray.random);
    const BsdfLobes& lobes = *sampled.component->lobes;
    const double total = lobes.total(lobes.look_up(e));
    if (!sampled.through || !hit.split) return total;
    return total - static_cast<double>(brightness(hit.through.transmittance));
}

/// Whether a direction belongs to the part that passes straight.
bool passes_straight(const BsdfHit& hit, const ProjectedDirection& e, const ProjectedDirection& l,
                     double area) {
    const double x = l.x + e.x, y = l.y + e.y;
    return hit.split && x * x + y * y <= area;
}

/// @param share  of the light that they carry together: -lw bounds their number
void add_samples(Ray& ray, const BsdfHit& hit, const SampledComponent& sampled, double share,
                 TraceContext& context) {
    const LightTransport& tracer = context.tracer;
    const double specular_samples = tracer.options().specular_samples;
    const BsdfLobes& lobes = *sampled.component->lobes;
    const double area = hit.resolution.least;
    const double narrow = std::clamp(specular_samples, 0.0, 1 - 1e-8);
    const int count = rough_sample_count(tracer.options(), ray.weight, share * ray.weight);
    for (int i = 0; i < count; ++i) {
        const ProjectedDirection e = jittered(hit, std::sqrt(area), specular_samples, ray.random);
        const BsdfLookup lookup = lobes.look_up(e);
        const double total = lobes.total(lookup);
        const auto narrowed_to = [&](double xi) { return kMiddle + narrow * (xi - 0.5); };
        const double choice = narrowed_to(ray.random.next());
        const auto [along, across] = ray.random.next_pair();
        const double xi1 = narrowed_to(along), xi2 = narrowed_to(across);
        if (!(total > 0)) continue;
        const BsdfLobes::Sample sample = lobes.sample(lookup, choice, xi1, xi2);
        if (sampled.through && passes_straight(hit, e, sample.l, area)) continue;
        Rgb coef = sample.color * static_cast<float>(total / count);
        if (sampled.through) coef *= hit.pattern;
        Ray child;
        if (!tracer.spawn(child, sampled.kind, ray, &coef)) continue;
        child.direction = normalize(hit.frame.direction(sample.l, sampled.side));
        if (sampled.through) child.origin -= ray.hit.normal * hit.thickness;
        tracer.trace(child, context);
        LightTransport::accumulate(ray, child);
    }
}

}  // namespace

void look_up_viewer(BsdfHit& hit) {
    SolidAngleRange all{kPi, 0};
    for (const bool through : {false, true}) {
        const BsdfComponent& part = through ? hit.transmission() : hit.reflection();
        if (!part.lobes) continue;
        BsdfLookup& lookup = through ? hit.in_transmission : hit.in_reflection;
        lookup = part.lobes->look_up(hit.e);
        const SolidAngleRange range = part.lobes->resolution(lookup);
        all = {std::min(all.least, range.least), std::max(all.largest, range.largest)};
    }
    if (all.largest > 0) hit.resolution = all;
}

ProjectedDirection jittered(const BsdfHit& hit, double size, double specular_samples,
                            RandomStream& random) {
    const double reach = size * std::min(specular_samples, 1.0);
    if (!(reach > 0)) return hit.e;
    const auto [x, y] = random.next_pair();
    const double dx = reach * (0.5 - x), dy = reach * (0.5 - y);
    const Vec3 moved = normalize({hit.e.x + dx, hit.e.y + dy, hit.height});
    return {moved.x, moved.y};
}

NearDirections jittered_near(const BsdfHit& hit, double size, double specular_samples,
                             RandomStream& random) {
    const double reach = size * std::min(specular_samples, 1.0);
    alignas(32) std::array<double, kNearDirections> square;
    NearDirections moved;
    for (std::size_t i = 0; i < kNearDirections; ++i) {
        moved.x[i] = random.next();
        moved.y[i] = random.next();
    }
    for (std::size_t i = 0; i < kNearDirections; ++i) {
        moved.x[i] = hit.e.x + reach * (0.5 - moved.x[i]);
        moved.y[i] = hit.e.y + reach * (0.5 - moved.y[i]);
        square[i] = std::fma(hit.height, hit.height,
                             std::fma(moved.x[i], moved.x[i], moved.y[i] * moved.y[i]));
    }
    for (std::size_t i = 0; i < kNearDirections; ++i) {
        const double inverse = 1 / std::sqrt(square[i]);
        moved.x[i] *= inverse;
        moved.y[i] *= inverse;
    }
    return moved;
}

BsdfDirect::BsdfDirect(const BsdfHit& hit, Ray& ray, const RenderOptions& options)
    : hit_(hit),
      specular_samples_(options.specular_samples),
      count_(std::max(
          1, static_cast<int>(std::floor(4 * options.specular_samples * ray.weight + 0.5)))) {
    if (specular_samples_ > 0) key_ = std::bit_cast<std::uint64_t>(ray.random.next());
}

Rgb BsdfDirect::operator()(const Vec3& wi, double omega) const {
    const double k = dot(hit_.facing(), wi), cosine = std::abs(k);
    if (cosine <= kEpsilon) return {};
    const bool through = k < 0;
    const BsdfComponent& component = through ? hit_.transmission() : hit_.reflection();
    const Rgb constant =
        (through ? hit_.transmitted : hit_.reflected) * static_cast<float>(cosine * omega / kPi);
    if (!component.lobes) return constant;
    const Rgb f = lobe(component, hit_.frame.project(wi), omega, cosine, through);
    const Rgb lobes = f * static_cast<float>(cosine * omega);
    return constant + (through ? lobes * hit_.pattern : lobes);
}

Rgb BsdfDirect::lobe(const BsdfComponent& component, const ProjectedDirection& l, double omega,
                     double cosine, bool through) const {
    constexpr auto kTiny = static_cast<float>(kEpsilon);
    const BsdfLobes& lobes = *component.lobes;
    if (through && hit_.split &&
        in_through_part(hit_.e, l, omega * cosine, lobes.least_solid_angle()))
        return max_component(hit_.through.surround) > kTiny ? hit_.through.surround : Rgb{};
    const BsdfLookup light = lobes.look_up_light(l);
    const BsdfLobes::Value at =
        lobes.value(through ? hit_.in_transmission : hit_.in_reflection, light);
    if (!(specular_samples_ > 0)) return brightness(at.f) > kTiny ? at.f : Rgb{};
    // The mean is that of values with the Lambertian part, of which those that have no lobe count
    // as nothing; then the part is taken off again. Lobes that end beside e lose light that way, as
    // they do in Radiance (measured: what its rtrace shows of trees of two values).
    const Rgb lambertian = component.lambertian * static_cast<float>(1 / kPi);
    RandomStream random = stream_for({l.x, l.y, cosine});
    const double size = std::sqrt(at.solid_angle);
    Rgb sum;
    int counted = 0;
    for (int first = 0; first < count_; first += kNear) {
        const auto near =
            lobes.values_near(jittered_near(hit_, size, specular_samples_, random), light);
        for (int i = 0; i < std::min(kNear, count_ - first); ++i) {
            const BsdfLobes::Value& value = near[static_cast<std::size_t>(i)];
            if (value.solid_angle < kSmallestNeighbour * at.solid_angle) continue;
            ++counted;
            if (value.has_lobe) sum += value.f + lambertian;
        }
    }
    return counted > 0 ? without(sum * (1 / static_cast<float>(counted)), lambertian) : Rgb{};
}

RandomStream BsdfDirect::stream_for(const Vec3& wi) const {
    std::uint64_t key = key_;
    for (std::size_t i = 0; i < 3; ++i) key = mix_bits(key ^ std::bit_cast<std::uint64_t>(wi[i]));
    return RandomStream(key);
}

UnsampledLobes add_bsdf_samples(Ray& ray, const BsdfHit& hit, TraceContext& context) {
    const RenderOptions& options = context.tracer.options();
    UnsampledLobes left;
    for (const bool through : {false, true}) {
        const BsdfComponent& component = through ? hit.transmission() : hit.reflection();
        if (!component.lobes) continue;
        const SampledComponent sampled{&component,
                                       through ? kSpecularTransmitted : kSpecularReflected,
                                       through ? -hit.side : hit.side, through};
        const double total = sampled_total(ray, hit, sampled, options.specular_samples);
        if (total > options.specular_threshold + kEpsilon) {
            const double tint = through ? static_cast<double>(max_component(hit.pattern)) : 1;
            add_samples(ray, hit, sampled, tint * total, context);
            continue;
        }
        const Rgb unsampled = Rgb::grey(static_cast<float>(std::max(0.0, total)));
        if (through)
            left.transmitted = unsampled * hit.pattern;
        else
            left.reflected = unsampled;
    }
    return left;
}

}  // namespace lightwalk
