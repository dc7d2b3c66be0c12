#include "apps/walk/walk_answers.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "core/math/corrected_sum.h"
#include "core/math/distance.h"
#include "core/math/xyz.h"
#include "core/scene/scene.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;

// Samples of each kind have random numbers of their own.
constexpr std::uint32_t kOfPixels = 0, kOfPickedPoints = 1, kOfMeans = 2, kOfPins = 3,
                        kOfSights = 4;
constexpr int kPixelRays = 4;     // along each side of a pixel, of each sample of it
constexpr int kPixelSamples = 8;  // they are apart in nothing but the chance in their light
// Of a picked point: as many as its time has room for. Indirect light is skewed where a small place
// is bright, by a lamp or a fire: the spread of 16 samples mostly misses what is rare and large.
constexpr int kFewestPointSamples = 16, kPointSamples = 128;
constexpr std::chrono::milliseconds kPointTime(30);
constexpr int kFirstSamples = 4;   // of a pin, before it is told
constexpr int kPinSamples = 1024;  // of a pin in the end

double luminance(const Rgb& radiance) {
    return double{kEfficacy} * static_cast<double>(brightness(radiance));
}

}  // namespace

WalkAnswers::WalkAnswers(const Tracer& tracer, WarningSink& warnings,
                         std::shared_ptr<const LightGroups> groups)
    : tracer_(tracer), warnings_(warnings), groups_(std::move(groups)) {}

void WalkAnswers::mix(LightMixture mixture) {
    mixture_ = std::move(mixture);
    if (sampler_) sampler_->mix(mixture_);
}

/// Made when somebody asks: most states of a scene that changes are not asked about.
LightSampler& WalkAnswers::sampler() {
    if (!sampler_) {
        sampler_.emplace(tracer_, warnings_, groups_);
        sampler_->mix(mixture_);
    }
    return *sampler_;
}

MeanInterval WalkAnswers::shown(const LightBatches& light) const {
    return light.interval([this](const SampledLight& part) { return sampler_->shown(part); });
}

MeanInterval WalkAnswers::pixel(const Camera& camera, double x, double y,
                                const std::pair<double, double>& size) {
    std::array<double, kPixelSamples> samples{};
    constexpr int kRays = kPixelRays * kPixelRays;
    std::uint32_t rays = 0;
    for (double& sample : samples) {
        int seen = 0;
        for (int k = 0; k < kRays; ++k) {
            const double h = x + ((k % kPixelRays + 0.5) / kPixelRays - 0.5) * size.first;
            const int row = k / kPixelRays;
            const double v = y + ((row + 0.5) / kPixelRays - 0.5) * size.second;
            const std::optional<Camera::ViewRay> ray = camera.ray(h, v);
            if (!ray) continue;
            sample += sampler().shown(sampler().radiance(ray->origin, ray->direction, ray->limit,
                                                         sampler().random(kOfPixels, rays++)));
            ++seen;
        }
        sample /= std::max(seen, 1);
    }
    return mean_interval(samples);
}

PickedReply WalkAnswers::pick(const PickRequest& request, const Camera& camera,
                              const std::pair<double, double>& pixel) {
    PickedReply reply;
    reply.id = request.id;
    const std::optional<Camera::ViewRay> middle = camera.ray(request.x, request.y);
    if (!middle) return reply;
    reply.luminance = this->pixel(camera, request.x, request.y, pixel);
    const Scene& scene = tracer_.scene();
    const Hit hit = scene.geometry().intersect(
        {middle->origin, middle->direction, farthest_hit(middle->limit)});
    reply.hit = hit.exists();
    if (!reply.hit) return reply;
    reply.distance = hit.t;
    reply.position = hit.position;
    reply.normal = dot(hit.normal, middle->direction) > 0 ? -hit.normal : hit.normal;
    LightBatches falling;
    const Clock::time_point end = Clock::now() + kPointTime;
    while (falling.count() < kFewestPointSamples ||
           (falling.count() < kPointSamples && Clock::now() < end))
        falling.add(sampler().irradiance(reply.position, reply.normal,
                                         random_of(kOfPickedPoints, falling)));
    reply.illuminance = shown(falling);
    const std::optional<ModifierId> material = scene.material_of(hit.modifier);
    reply.material = material ? scene.modifier(*material).name : "void";
    reply.surface = scene.surface(hit.surface).name();
    return reply;
}

MeanReply WalkAnswers::mean(const MeanRequest& request, const LivePicture& picture,
                            const View& view, FrameOptions options) {
    options.width = picture.width;
    options.height = picture.height;
    const Camera camera(view);
    const PixelRays rays = rays_of_sample(camera, options, 0);
    const auto pixels = [](double from, double to, int size) {
        const int first = std::clamp(static_cast<int>(std::floor(from * size)), 0, size - 1);
        const int last = std::clamp(static_cast<int>(std::ceil(to * size)), first + 1, size);
        return std::pair{first, last};
    };
    const auto x = pixels(request.x0, request.x1, picture.width);
    const auto y = pixels(1 - request.y1, 1 - request.y0, picture.height);
    const int width = x.second - x.first;
    const auto count =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(y.second - y.first);
    std::vector<KnownTerm> terms;
    terms.reserve(count);
    for (int row = y.first; row < y.second; ++row) {
        const std::size_t first =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width);
        for (int column = x.first; column < x.second; ++column)
            terms.push_back(
                {1 / static_cast<double>(count),
                 luminance(picture.radiance[first + static_cast<std::size_t>(column)])});
    }
    std::uint32_t samples = 0;
    // Where the picture has looked: what a pixel shows besides is not what chance has made of it.
    const auto sample = [&](std::size_t term) {
        const int place = static_cast<int>(term);
        const int column = x.first + place % width, row = y.first + place / width;
        const std::optional<Camera::ViewRay> ray = rays(column, picture.height - 1 - row).ray;
        return ray ? sampler().shown(sampler().radiance(ray->origin, ray->direction, ray->limit,
                                                        sampler().random(kOfMeans, samples++)))
                   : terms[term].value;
    };
    MeanInterval mean = corrected_sum(terms, sampler().random(kOfMeans, ~0u), sample);
    mean.mean = std::max(mean.mean, 0.0);
    return {request.id, mean, count};
}

ProbesReply WalkAnswers::measure(std::span<const ProbePlace> probes, const Vec3& eye,
                                 double seconds) {
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(seconds));
    std::map<std::uint32_t, Pin> kept;
    for (const ProbePlace& probe : probes) {
        Pin& pin = kept[probe.id];
        if (const auto before = pins_.find(probe.id); before != pins_.end())
            pin = std::move(before->second);
        if (pin.position != probe.position || pin.normal != probe.normal) pin = {};
        pin.position = probe.position;
        pin.normal = probe.normal;
        if (pin.eye != eye) pin.seen.clear();
        pin.eye = eye;
    }
    pins_ = std::move(kept);
    bool more = true;
    for (int round = 0; more && (round < kFirstSamples || Clock::now() < end); ++round) {
        more = false;
        for (auto& [id, pin] : pins_) more |= sample(pin);
    }
    return known();
}

bool WalkAnswers::sample(Pin& pin) {
    if (pin.falling.count() < kPinSamples)
        pin.falling.add(
            sampler().irradiance(pin.position, pin.normal, random_of(kOfPins, pin.falling)));
    if (pin.seen.count() < kPinSamples) {
        const Vec3 way = pin.position - pin.eye;
        constexpr double kBeyond = 1.001;  // so that the ray reaches the pin's surface
        const double far = length(way);
        pin.seen.add(far > kEpsilon ? sampler().radiance(pin.eye, way * (1 / far), kBeyond * far,
                                                         random_of(kOfSights, pin.seen))
                                    : SampledLight{});
    }
    return std::min(pin.falling.count(), pin.seen.count()) < kPinSamples;
}

RandomStream WalkAnswers::random_of(std::uint32_t kind, const LightBatches& light) {
    return sampler().random(kind, static_cast<std::uint32_t>(light.count()));
}

ProbesReply WalkAnswers::known() const {
    ProbesReply reply;
    int fewest = kPinSamples;
    for (const auto& [id, pin] : pins_) {
        reply.probes.push_back({id, shown(pin.falling), shown(pin.seen)});
        fewest = std::min({fewest, pin.falling.count(), pin.seen.count()});
    }
    reply.settled = static_cast<double>(fewest) / kPinSamples;
    return reply;
}

std::optional<double> height_above_ground(const Geometry& geometry, const Vec3& eye,
                                          const Vec3& up) {
    const Hit below = geometry.intersect({eye, -normalize(up), kHuge});
    return below.exists() ? std::optional(below.t) : std::nullopt;
}

}  // namespace lightwalk
