#include "apps/rank_walk.h"

#include <utility>

#include "apps/interrupt.h"
#include "apps/rank_pictures.h"
#include "parallel/walk/scene_caster.h"
#include "parallel/walk/walk_frame.h"

namespace lightwalk {
namespace {

/// A view of the scene, and its rays.
class SceneRays final : public WalkRays {
  public:
    SceneRays(const View& view, const Tracer& tracer, const VisibilityProbe& visibility,
              const FrameOptions& options, WorkerContexts& contexts, const StopFlag& stop)
        : camera_(view),
          contexts_(contexts),
          caster_(tracer, visibility, camera_, options, contexts, stop) {}
    [[nodiscard]] const Camera& camera() const override { return camera_; }
    void probe(std::span<const PixelPlace> places, std::span<PixelVisibility> visibility,
               int worker) override {
        caster_.probe(places, visibility, worker);
    }
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int sample,
               int worker) override {
        caster_.trace(places, pixels, sample, worker);
    }
    [[nodiscard]] std::uint64_t traced() const override { return contexts_.rays().total(); }

  private:
    Camera camera_;
    const WorkerContexts& contexts_;
    SceneCaster caster_;
};

}  // namespace

LeadWalk::LeadWalk(RankLink& link, const Tracer& tracer, const CloudOptions& options,
                   std::size_t frames, const ProgressOptions& progress, StderrWarnings& warnings,
                   RunStatistics& statistics)
    : link_(link),
      tracer_(tracer),
      options_(options),
      frames_wanted_(frames),
      progress_(progress),
      warnings_(warnings),
      statistics_(statistics),
      executor_(make_executor(ExecutorKind::serial, 1)),
      contexts_(tracer, warnings, 1) {}

LeadWalk::~LeadWalk() {
    statistics_.rays += contexts_.rays();
}

std::optional<Frame> LeadWalk::take() {
    const std::shared_ptr<const PictureRequest> request = std::move(requests_.front());
    requests_.pop_front();
    const FrameOptions& options = request->options;
    begin(options);
    PictureOrder picture;
    picture.view = request->camera.view();
    picture.width = options.width;
    picture.height = options.height;
    const View* next = requests_.empty() ? nullptr : &requests_.front()->camera.view();
    link_.submit(lead_->order(picture.view, next, encode_order(picture)));
    const std::optional<FinishedFrame> finished = link_.wait_for_frame(interrupt_flag());
    if (finished) {
        ++frames_done_;
        meter_->update(
            0, {static_cast<double>(frames_done_) / static_cast<double>(frames_wanted_), 0, 0});
    }
    if (!finished || frames_done_ == frames_wanted_) {
        meter_->finish(finished.has_value(), 0);
        meter_.reset();
        warnings_.use_terminal_line(false);
    }
    if (!finished) return std::nullopt;
    CloudFrame drawn = lead_->take(*finished);
    Frame frame = turned_over(drawn, options.width, options.height);
    draw_small_sources(tracer_, request->camera, options, *executor_, contexts_, frame);
    frame.complete = true;
    statistics_.walk.add(std::move(drawn.report));
    return frame;
}

void LeadWalk::begin(const FrameOptions& options) {
    if (!lead_ || width_ != options.width || height_ != options.height)
        lead_.emplace(options.width, options.height, options_, frames_done_);
    width_ = options.width;
    height_ = options.height;
    if (meter_) return;
    WorkPhase all;
    all.pixels = static_cast<double>(options.whole().pixels() * frames_wanted_);
    meter_.emplace(progress_, std::vector{all});
    warnings_.use_terminal_line(progress_.bar);
}

void RankWalk::serve(Executor& executor) {
    link_.draw_walk(
        executor, cloud_, projectors_,
        [&](const CloudOrder& order) { return make_rays(order, executor); }, stop_);
}

std::unique_ptr<WalkRays> RankWalk::make_rays(const CloudOrder& order, Executor& executor) {
    FrameOptions options = options_;
    options.width = order.width;
    options.height = order.height;
    const PictureOrder picture = decode_order(order.payload);
    if (direct_ != nullptr && !picture.indirect)
        return std::make_unique<SceneRays>(picture.view, direct_->tracer, direct_->visibility,
                                           options, direct_->contexts, stop_);
    auto rays = std::make_unique<SceneRays>(picture.view, session_.tracer(), probe_, options,
                                            contexts_, stop_);
    if (order.rules.empty || prepass_ == CachePrepass::deterministic)
        run_prepass(rays->camera(), options, executor);
    return rays;
}

/// Of a quick one each rank plays a part: what it finds goes to the others as all values do.
void RankWalk::run_prepass(const Camera& camera, FrameOptions options, Executor& executor) {
    if (prepass_ == CachePrepass::none || !session_.freezable) return;
    RoundExchange& rounds = link_.rounds();
    if (prepass_ == CachePrepass::quick) {
        const SubImages parts(options.whole(), static_cast<std::size_t>(rounds.count()));
        options.window = parts[static_cast<std::size_t>(rounds.index())];
        if (options.window->empty()) return;
    }
    WorkerContexts contexts(session_.tracer(), warnings_, executor.concurrency());
    const CachePrepassResult played = fill_ambient_cache(
        session_.tracer(), camera, options, prepass_, *session_.freezable, executor, contexts,
        stop_, [](const FrameProgress&) {},
        prepass_ == CachePrepass::deterministic ? &rounds : nullptr);
    prepass_rays_ += played.rays;
    prepass_ambient_ += played.ambient;
}

RayCounters RankWalk::rays() const {
    RayCounters sum = prepass_rays_;
    sum += contexts_.rays();
    return sum;
}

AmbientCounters RankWalk::ambient() const {
    AmbientCounters sum = prepass_ambient_;
    sum += contexts_.ambient();
    return sum;
}

}  // namespace lightwalk
