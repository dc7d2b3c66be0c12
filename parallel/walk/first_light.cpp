#include "parallel/walk/first_light.h"

#include <algorithm>
#include <utility>

#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

constexpr double kSoon = 1;  // values of the picture that take longer wait for its pixels [s]
constexpr double kRoughAccuracy = 0.2;
constexpr int kRoughResolution = 64, kRoughDivisions = 128, kRoughSuperSamples = 32;

AmbientLimits limits_of(const Scene& scene, const RenderOptions& options) {
    const SceneCube cube = scene.cube();
    return ambient_limits(cube.origin, cube.size, options.ambient_accuracy,
                          options.ambient_resolution);
}

}  // namespace

RenderOptions rough_options(RenderOptions options) {
    options.ambient_bounces = std::min(options.ambient_bounces, 1);
    options.ambient_accuracy = std::max(options.ambient_accuracy, kRoughAccuracy);
    if (options.ambient_resolution <= 0 || options.ambient_resolution > kRoughResolution)
        options.ambient_resolution = kRoughResolution;
    options.ambient_divisions = std::min(options.ambient_divisions, kRoughDivisions);
    options.ambient_super_samples = std::min(options.ambient_super_samples, kRoughSuperSamples);
    return options;
}

bool FirstLight::is_rough(const RenderOptions& options) {
    const RenderOptions rough = rough_options(options);
    return options.ambient_bounces == rough.ambient_bounces &&
           options.ambient_accuracy >= rough.ambient_accuracy &&
           options.ambient_resolution == rough.ambient_resolution &&
           options.ambient_divisions == rough.ambient_divisions &&
           options.ambient_super_samples == rough.ambient_super_samples;
}

FirstLight::Rough::Rough(const FirstLight& light, const RenderOptions& options)
    : tracer(light.indirect_.scene(), options, silence, SerialTaskRunner(),
             &light.indirect_.lights().measures()),
      cache(limits_of(light.indirect_.scene(), options)),
      draft(tracer, light.direct_, light.groups_, light.workers_) {
    tracer.use_ambient_cache(&cache);
    draft.mix(light.mixture_);
}

FirstLight::FirstLight(const Tracer& indirect, const Tracer& direct,
                       std::shared_ptr<const LightGroups> groups, int workers)
    : indirect_(indirect), direct_(direct), groups_(std::move(groups)), workers_(workers) {
    if (indirect.options().ambient_accuracy > kEpsilon)
        fine_ = std::make_unique<DraftLight>(indirect_, direct_, groups_, workers_);
}

ViewDraft FirstLight::step(const View& view, const FrameOptions& options, double seconds,
                           Executor& executor, const StopFlag& stop) {
    if (!rough_ && !(fine_ && is_rough(indirect_.options())))
        rough_ = std::make_unique<Rough>(*this, rough_options(indirect_.options()));
    if (rough_) (void)rough_->draft.aim(view, options);
    if (fine_ && fine_->aim(view, options)) fine_seconds_ = 0;
    if (DraftLight* const draft = next()) {
        const Clock::time_point begin = Clock::now();
        draft->step(seconds, executor, stop);
        if (draft == fine_.get())
            fine_seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
        rays_ = draft->rays();
    }
    ViewDraft made;
    if (fine_ && fine_->usable())
        made.best = fine_.get();
    else if (rough_ && rough_->draft.usable())
        made.best = &rough_->draft;
    made.last = next() == nullptr;
    return made;
}

/// The draft to work on; null: all is done that is to be done.
DraftLight* FirstLight::next() {
    if (rough_ && !rough_->draft.usable()) return &rough_->draft;
    if (fine_ && fine_->whole()) return nullptr;
    if (fine_ && (!rough_ || fine_->filled() || fine_seconds_ < kSoon)) return fine_.get();
    return rough_->draft.whole() ? nullptr : &rough_->draft;
}

void FirstLight::mix(const LightMixture& mixture) {
    mixture_ = mixture;
    if (fine_) fine_->mix(mixture);
    if (rough_) rough_->draft.mix(mixture);
}

}  // namespace lightwalk
