#include "apps/session/local_backend.h"

#include <utility>

#include "apps/session/cloud_pictures.h"
#include "apps/session/local_pictures.h"
#include "apps/session/local_rays.h"

namespace lightwalk {

std::unique_ptr<Executor> make_executor(const RendererOptions& options) {
    return make_executor(options.executor.value_or(kDefaultExecutor),
                         options.threads > 0 ? options.threads : hardware_threads());
}

LocalBackend::LocalBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options)
    : RenderBackend(std::move(options)),
      session_(std::move(scene), light(), warnings()),
      executor_(make_executor(this->options())),
      contexts_(session_.tracer(), warnings(), executor_->concurrency()) {}

PictureMaker& LocalBackend::pictures() {
    if (pictures_) return *pictures_;
    const LocalWorkers workers{session_, *executor_, contexts_, stop(), statistics_};
    if (options().reuse)
        pictures_ = std::make_unique<CloudPictures>(workers, prepass(), *options().reuse,
                                                    options().frames, listener(), warnings());
    else
        pictures_ = std::make_unique<LocalPictures>(workers, prepass(), listener());
    return *pictures_;
}

RayMaker& LocalBackend::rays() {
    if (!rays_)
        rays_ = std::make_unique<LocalRays>(session_.tracer(), *executor_, contexts_, options(),
                                            stop());
    return *rays_;
}

LiveFrames& LocalBackend::frames() {
    if (frames_) return *frames_;
    direct_ = without_indirect(session_, warnings());
    const Tracer& tracer = direct_ ? *direct_ : session_.tracer();
    const Tracer* const indirect = direct_ ? &session_.tracer() : nullptr;
    frames_ = std::make_unique<LocalFrames>(tracer, indirect, *options().reuse, frame_options(0, 0),
                                            *executor_, warnings());
    return *frames_;
}

RunStatistics LocalBackend::statistics() const {
    RunStatistics statistics = statistics_;
    if (rays_) {
        statistics.rays = contexts_.rays();
        statistics.ambient = contexts_.ambient();
    }
    statistics.threads = executor_->concurrency();
    statistics.add_session(session_);
    return statistics;
}

}  // namespace lightwalk
