#include "apps/session/scene_session.h"

#include <atomic>
#include <optional>
#include <utility>

#include "apps/session/light_memo.h"
#include "apps/session/stopwatch.h"
#include "core/light/light_sources.h"
#include "parallel/executor.h"
#include "parallel/executor_task_runner.h"

namespace lightwalk {
namespace {

/// Of records of coefficients: what a sensor sees of the walls is the mean of hundreds of them, so
/// that with fewer samples each there is no more noise, but less to trace.
constexpr double kEffort = 0.25;

/// Notes whether there was one.
class NotedWarnings final : public WarningSink {
  public:
    explicit NotedWarnings(WarningSink& sink) : sink_(sink) {}
    void warn(const std::string& message) override {
        any_ = true;
        sink_.warn(message);
    }
    [[nodiscard]] bool any() const { return any_; }

  private:
    WarningSink& sink_;
    std::atomic<bool> any_ = false;
};

std::unique_ptr<Tracer> make_tracer(const CompiledScene& compiled, const RenderOptions& light,
                                    WarningSink& warnings, const TaskRunner& task_runner) {
    LightMemo* const memo = compiled.light_memo();
    const std::optional<LightMeasures> known = memo ? memo->find(light) : std::nullopt;
    NotedWarnings noted(warnings);
    auto tracer = std::make_unique<Tracer>(compiled.scene(), light, noted, task_runner,
                                           known ? &*known : nullptr);
    // What there is to warn of is found anew each time.
    if (memo && !known && !noted.any()) memo->keep(light, tracer->lights().measures());
    return tracer;
}

}  // namespace

bool caches_ambient_values(const RenderOptions& light) {
    return light.ambient_bounces > 0 && light.ambient_accuracy > kEpsilon;
}

SceneSession::SceneSession(std::shared_ptr<const CompiledScene> compiled,
                           const RenderOptions& light, const std::string& ambient_file,
                           OthersValues others, bool keeps_coefficients, WarningSink& warnings,
                           const std::string& begun)
    : compiled_(std::move(compiled)), warnings_(warnings), cost_(compiled_->cost()) {
    const Stopwatch watch;
    const std::unique_ptr<Executor> executor =
        make_executor(kDefaultExecutor, compiled_->threads());
    auto tracer = make_tracer(*compiled_, light, warnings, ExecutorTaskRunner(*executor));
    if (keeps_coefficients) {
        coefficients = std::make_unique<CoefficientCache>(limits_of(light), kEffort);
        tracer->use_coefficients(coefficients.get());
    } else if (caches_ambient_values(light)) {
        make_cache(light, ambient_file, others, begun);
        tracer->use_ambient_cache(freezable.get());
    } else if (!ambient_file.empty()) {
        warnings.warn("the ambient file is not opened: it needs -ab and -aa above zero");
    }
    tracer_ = std::move(tracer);
    cost_.build_seconds += watch.seconds();
    cost_.build_peak_bytes = peak_memory_bytes();
}

AmbientLimits SceneSession::limits_of(const RenderOptions& light) const {
    const SceneCube cube = scene().cube();
    return ambient_limits(cube.origin, cube.size, light.ambient_accuracy, light.ambient_resolution);
}

void SceneSession::make_cache(const RenderOptions& light, const std::string& ambient_file,
                              OthersValues others, const std::string& begun) {
    ambient = std::make_unique<ConcurrentCache>(limits_of(light));
    freezable = std::make_unique<PublishedCache>(*ambient);
    if (ambient_file.empty()) return;
    ambient_store =
        std::make_unique<AmbientStore>(ambient_file, light, *ambient, warnings_, others, begun);
    known = ambient_store->take_loaded();
    freezable->add(*ambient_store);
}

void SceneSession::warn_of_darkness() const {
    if (!tracer_->lights().shine()) warnings_.warn("no light sources found");
}

}  // namespace lightwalk
