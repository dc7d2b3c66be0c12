#include "parallel/cache_prepass.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "parallel/ambient_rounds.h"
#include "parallel/block_renderer.h"
#include "parallel/blocks.h"

namespace lightwalk {
namespace {

/// The step (distance of traced pixels in either direction) of each coarse picture.
std::vector<int> steps_of(CachePrepass prepass) {
    switch (prepass) {
        case CachePrepass::none:
            break;
        case CachePrepass::quick:
            return {kQuickStep};
        case CachePrepass::deterministic:
            return {16, 8, 4, 2, 1};
    }
    return {};
}

/// All pixels of the coarse picture of a step that `window` touches.
PixelRectangle coarser(const PixelRectangle& window, int step) {
    return {window.x0 / step, window.y0 / step, (window.x1 + step - 1) / step,
            (window.y1 + step - 1) / step};
}

FrameOptions coarse_options(const FrameOptions& options, CachePrepass prepass, int step) {
    FrameOptions coarse = options;
    coarse.step = step;
    coarse.pixels.spacing = 1;
    coarse.hits = false;
    coarse.window.reset();
    if (step > 1) {
        coarse.pixels.samples = 1;
        coarse.previous = nullptr;
    }
    if (options.window && prepass != CachePrepass::deterministic)
        coarse.window = coarser(*options.window, step);
    return coarse;
}

/// The prepass of one picture: its arguments, and what it took so far. A finer picture has more
/// pixels, but fewer missing values for each: its share of the work is taken as the root of its
/// pixel density.
class PrepassRun {
  public:
    PrepassRun(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
               CachePrepass prepass, PublishedCache& cache, Executor& executor,
               WorkerContexts& contexts, const StopFlag& stop, TakeProgress progress)
        : tracer_(tracer),
          camera_(camera),
          options_(options),
          prepass_(prepass),
          cache_(cache),
          executor_(executor),
          contexts_(contexts),
          stop_(stop),
          progress_(progress) {
        for (const int step : steps_of(prepass)) all_ += share_of(step);
    }

    /// The coarse pictures fill the cache as they go. False: stopped.
    [[nodiscard]] bool fill_by_pictures() {
        for (const int step : steps_of(prepass_)) {
            const auto tell_progress = [&](const FrameProgress& now) { tell(step, now); };
            const Frame frame = render_frame(tracer_, camera_, coarse(step), executor_, contexts_,
                                             stop_, tell_progress);
            add(frame.rays, frame.ambient);
            if (!frame.complete) return false;
            before_ += share_of(step);
        }
        return true;
    }

    /// For one coarse picture after another, finds the ambient values that its pixels lack, and
    /// computes them in rounds. False: stopped.
    [[nodiscard]] bool fill_in_rounds(Group& exchange, CheckpointSink* checkpoint) {
        int step = 1;            // of the present picture
        std::size_t points = 0;  // without a value that its pixels found
        double told = 0;
        const auto tell_done = [&](double done) {
            told = done;
            tell(step, {done, contexts_.rays().total(), contexts_.ambient().computed});
        };
        AmbientRounds rounds(
            tracer_, cache_, executor_, contexts_, exchange, stop_,
            [&](std::size_t left) {
                tell_done(1 -
                          (1 - kLooked) * static_cast<double>(left) / static_cast<double>(points));
            },
            checkpoint);
        for (const int next_step : steps_of(prepass_)) {
            step = next_step;
            contexts_.reset_counters();
            std::vector<AmbientPoint> found = rounds.collect([&] { look_at(step, exchange); });
            points = found.size();
            if (!rounds.stopped()) tell_done(found.empty() ? 1 : kLooked);
            rounds.compute_in_rounds(std::move(found));
            if (!rounds.stopped() && told < 1) tell_done(1);  // the last got values of others
            add(contexts_.rays(), contexts_.ambient());
            if (rounds.stopped()) return false;
            before_ += share_of(step);
        }
        return !rounds.left_out() || fill_left_out();
    }

    [[nodiscard]] const CachePrepassResult& result() const { return result_; }

  private:
    static constexpr double kLooked = 0.1;  ///< share of the work that is finding the points
    static double share_of(int step) { return 1 / std::sqrt(step); }
    [[nodiscard]] FrameOptions coarse(int step) const {
        return coarse_options(options_, prepass_, step);
    }

    /// Trace this process's share of the pixels, to find missing values.
    void look_at(int step, const Group& exchange) const {
        const BlockRenderer renderer(tracer_, camera_, coarse(step), contexts_, stop_);
        const PixelRectangle area = renderer.options().area();
        const int workers = executor_.concurrency() * exchange.size();
        const std::vector<Block> all = make_blocks(
            area, block_side(area.width(), area.height(), workers, renderer.alignment()));
        std::vector<Block> mine;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (exchange.does(i)) mine.push_back(all[i]);
        }
        render_blocks(renderer, mine, executor_, stop_, [](const BlockPixels&, int) {});
    }

    /// After all pictures: values at points inside clipped matter or a scattering mist, which
    /// rounds cannot compute. One worker computes them, in each process the same ones. False:
    /// stopped.
    [[nodiscard]] bool fill_left_out() {
        const std::unique_ptr<Executor> one = make_executor(ExecutorKind::serial, 1);
        cache_.freeze(false);
        for (const int step : {16, 8, 4, 2}) {
            const Frame frame = render_frame(tracer_, camera_, coarse(step), *one, contexts_, stop_,
                                             [](const FrameProgress&) {});
            add(frame.rays, frame.ambient);
            if (!frame.complete) return false;
        }
        cache_.freeze(true);
        return true;
    }

    /// Report progress of the present picture, of every `step`-th pixel.
    void tell(int step, const FrameProgress& now) const {
        progress_({std::min(1.0, (before_ + now.done * share_of(step)) / all_),
                   result_.rays.total() + now.rays, result_.ambient.computed + now.ambient_values});
    }
    void add(const RayCounters& rays, const AmbientCounters& ambient) {
        result_.rays += rays;
        result_.ambient += ambient;
    }

    const Tracer& tracer_;
    const Camera& camera_;
    const FrameOptions& options_;
    CachePrepass prepass_;
    PublishedCache& cache_;
    Executor& executor_;
    WorkerContexts& contexts_;
    const StopFlag& stop_;
    TakeProgress progress_;
    double all_ = 0, before_ = 0;  ///< shares of all pictures, and of those that are done
    CachePrepassResult result_;
};

}  // namespace

FrameOptions quick_prepass(const FrameOptions& options, int step) {
    return coarse_options(options, CachePrepass::quick, step);
}

std::size_t prepass_pixels(const FrameOptions& options, CachePrepass prepass) {
    std::size_t pixels = 0;
    for (const int step : steps_of(prepass))
        pixels += coarse_options(options, prepass, step).area().pixels();
    return pixels;
}

CachePrepassResult fill_ambient_cache(const Tracer& tracer, const Camera& camera,
                                      const FrameOptions& options, CachePrepass prepass,
                                      PublishedCache& cache, Executor& executor,
                                      WorkerContexts& contexts, const StopFlag& stop,
                                      TakeProgress progress, Group* exchange,
                                      CheckpointSink* checkpoint) {
    PrepassRun run(tracer, camera, options, prepass, cache, executor, contexts, stop, progress);
    GroupOfOne alone;
    cache.freeze(false);
    const bool complete =
        prepass == CachePrepass::deterministic
            ? run.fill_in_rounds(exchange != nullptr ? *exchange : alone, checkpoint)
            : run.fill_by_pictures();
    if (!complete) cache.freeze(false);
    CachePrepassResult result = run.result();
    result.complete = complete;
    return result;
}

}  // namespace lightwalk
