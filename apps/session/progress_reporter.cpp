#include "apps/session/progress_reporter.h"

#include <utility>

namespace lightwalk {

ProgressReporter::ProgressReporter(ProgressListener listener, std::vector<WorkPhase> phases)
    : listener_(std::move(listener)), estimator_(std::move(phases)) {
    report(RenderProgress::Stage::begun, 0);
}

void ProgressReporter::update(std::size_t phase, const FrameProgress& progress) {
    if (phase != phase_) rays_before_ = rays_;
    phase_ = phase;
    rays_ = rays_before_ + progress.rays;
    estimator_.add(phase, watch_.seconds(), progress);
    if (watch_.seconds() - reported_ < listener_.interval) return;
    report(RenderProgress::Stage::running, estimator_.estimate().done);
    reported_ = watch_.seconds();
}

void ProgressReporter::finish(bool complete, std::uint64_t rays) {
    rays_ = rays;
    if (complete)
        report(RenderProgress::Stage::finished, 1);
    else
        report(RenderProgress::Stage::cancelled, estimator_.estimate().done);
}

void ProgressReporter::report(RenderProgress::Stage stage, double done) {
    if (!listener_.tell) return;
    RenderProgress progress;
    progress.stage = stage;
    progress.done = done;
    progress.rays = rays_;
    progress.error = error_;
    progress.seconds = watch_.seconds();
    progress.seconds_left = estimator_.estimate().seconds_left;
    listener_.tell(progress);
}

}  // namespace lightwalk
