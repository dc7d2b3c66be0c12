#include "core/trace/light_sampler.h"

#include <algorithm>
#include <utility>

#include "core/light/light_sources.h"
#include "core/math/replication_seed.h"
#include "core/math/xyz.h"

namespace lightwalk {
namespace {

/// Of a hemisphere: more samples rather than larger ones, since it is these that an interval
/// counts.
constexpr int kDivisions = 64;

RenderOptions uncached(RenderOptions options) {
    options.ambient_accuracy = 0;
    options.ambient_super_samples = 0;
    options.ambient_divisions = std::min(options.ambient_divisions, kDivisions);
    return options;
}

}  // namespace

void LightBatches::add(const SampledLight& light) {
    const auto count = static_cast<std::size_t>(count_);
    SampledLight& mean = means_[count % kBatches];
    const std::size_t samples = count / kBatches + 1;  // in this batch, with this one
    const float share = 1 / static_cast<float>(samples);
    mean.groups.resize(light.groups.size());
    // Equal samples have exactly that mean.
    mean.whole += share * (light.whole - mean.whole);
    for (std::size_t g = 0; g < light.groups.size(); ++g)
        mean.groups[g] += share * (light.groups[g] - mean.groups[g]);
    ++count_;
}

MeanInterval LightBatches::interval(FunctionRef<double(const SampledLight&)> shown) const {
    constexpr int kParts = kBatches;
    std::array<AnswerBatch, kBatches> batches;
    for (int i = 0; i < kParts; ++i) {
        AnswerBatch& batch = batches[static_cast<std::size_t>(i)];
        batch.count = count_ / kParts + (i < count_ % kParts ? 1 : 0);
        if (batch.count > 0) batch.mean = shown(means_[static_cast<std::size_t>(i)]);
    }
    return mean_interval(batches);
}

LightSampler::LightSampler(const Tracer& tracer, WarningSink& warnings,
                           std::shared_ptr<const LightGroups> groups)
    : tracer_(tracer.scene(), uncached(tracer.options()), silence_, SerialTaskRunner(),
              &tracer.lights().measures()),
      context_(tracer_, warnings) {
    if (!groups) return;
    sums_ = std::make_unique<GroupSums>(std::move(groups));
    context_.contributions = context_.groups = sums_.get();
}

RandomStream LightSampler::random(std::uint32_t kind, std::uint32_t sample) const {
    constexpr int kApart = 1 << 20;  // from the replications of a command
    return RandomStream::of_pixel(replication_seed(tracer_.options().seed, kApart), kind, 0,
                                  sample);
}

SampledLight LightSampler::radiance(const Vec3& origin, const Vec3& direction, double limit,
                                    RandomStream random) {
    Ray ray = tracer_.primary(origin, direction, limit, random);
    if (sums_) sums_->clear();
    tracer_.trace(ray, context_);
    return light_of(ray.value);
}

SampledLight LightSampler::irradiance(const Vec3& point, const Vec3& normal, RandomStream random) {
    if (sums_) sums_->clear();
    return light_of(tracer_.irradiance(point, normal, random, context_).value);
}

SampledLight LightSampler::light_of(const Rgb& value) const {
    if (!sums_) return {value, {}};
    return {value, {sums_->sums().begin(), sums_->sums().end()}};
}

double LightSampler::shown(const SampledLight& light) const {
    const Rgb mixed = sums_ ? mixture_(light.whole, light.groups) : light.whole;
    return double{kEfficacy} * static_cast<double>(brightness(mixed));
}

}  // namespace lightwalk
