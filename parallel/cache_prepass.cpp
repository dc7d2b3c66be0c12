#include "parallel/cache_prepass.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
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

/// Progress of a prepass over its coarse pictures. A finer picture has more pixels, but fewer
/// missing values for each: its share of the work is taken as the root of its pixel density.
class CachePrepassSum {
  public:
    CachePrepassSum(const std::vector<int>& steps, TakeProgress progress) : progress_(progress) {
        for (const int step : steps) all_ += share_of(step);
    }

    /// Report progress of the present picture, of every `step`-th pixel.
    void tell(int step, const FrameProgress& now) {
        progress_({std::min(1.0, (before_ + now.done * share_of(step)) / all_),
                   result_.rays.total() + now.rays, result_.ambient.computed + now.ambient_values});
    }
    void add(int step, const RayCounters& rays, const AmbientCounters& ambient) {
        add(rays, ambient);
        before_ += share_of(step);
    }
    void add(const RayCounters& rays, const AmbientCounters& ambient) {
        result_.rays += rays;
        result_.ambient += ambient;
    }
    [[nodiscard]] CachePrepassResult result(bool complete) const {
        CachePrepassResult result = result_;
        result.complete = complete;
        return result;
    }

  private:
    static double share_of(int step) { return 1 / std::sqrt(step); }

    TakeProgress progress_;
    double all_ = 0, before_ = 0;
    CachePrepassResult result_;
};

/// Arguments of rendering coarse pictures.
struct Players {
    const Tracer& tracer;
    const Camera& camera;
    PublishedCache& cache;
    Executor& executor;
    WorkerContexts& contexts;
    Group& exchange;
    const StopFlag& stop;
};

/// For one coarse picture after another, finds the ambient values that its pixels lack, and
/// computes them in rounds.
class DeterministicPrepass {
  public:
    DeterministicPrepass(const Players& players, CachePrepassSum& sum)
        : players_(players),
          sum_(sum),
          rounds_(players.tracer, players.cache, players.executor, players.contexts,
                  players.exchange, players.stop,
                  [this](std::size_t left) { tell_of_round(left); }) {}

    /// False: stopped.
    [[nodiscard]] bool play(const FrameOptions& coarse) {
        step_ = coarse.step;
        players_.contexts.reset_counters();
        std::vector<AmbientPoint> points = rounds_.collect([&] { look_at(coarse); });
        points_ = points.size();
        if (!rounds_.stopped()) tell(points.empty() ? 1 : kLooked);
        rounds_.compute_in_rounds(std::move(points));
        if (!rounds_.stopped() && told_ < 1) tell(1);  // the last points got values of others
        sum_.add(step_, players_.contexts.rays(), players_.contexts.ambient());
        return !rounds_.stopped();
    }

    /// After all pictures: values at points inside clipped matter or a scattering mist, which
    /// rounds cannot compute. One worker computes them, in each process the same ones. False:
    /// stopped.
    [[nodiscard]] bool play_left_out(const FrameOptions& options) {
        if (!rounds_.left_out()) return true;
        const std::unique_ptr<Executor> one = make_executor(ExecutorKind::serial, 1);
        players_.cache.freeze(false);
        for (const int step : {16, 8, 4, 2}) {
            const Frame frame =
                render_frame(players_.tracer, players_.camera,
                             coarse_options(options, CachePrepass::deterministic, step), *one,
                             players_.contexts, players_.stop, [](const FrameProgress&) {});
            sum_.add(frame.rays, frame.ambient);
            if (!frame.complete) return false;
        }
        players_.cache.freeze(true);
        return true;
    }

  private:
    static constexpr double kLooked = 0.1;  ///< share of the work that is finding the points

    /// Trace this process's share of the pixels, to find missing values.
    void look_at(const FrameOptions& coarse) {
        const BlockRenderer renderer(players_.tracer, players_.camera, coarse, players_.contexts,
                                     players_.stop);
        const PixelRectangle area = coarse.area();
        const int workers = players_.executor.concurrency() * players_.exchange.size();
        const std::vector<Block> all = make_blocks(
            area, block_side(area.width(), area.height(), workers, renderer.alignment()));
        std::vector<Block> mine;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (players_.exchange.does(i)) mine.push_back(all[i]);
        }
        BlockQueue blocks(std::move(mine));
        render_blocks(renderer, blocks, players_.executor, players_.stop,
                      [](const BlockPixels&, int) {});
    }

    /// @param left  points that the round has left
    void tell_of_round(std::size_t left) {
        tell(1 - (1 - kLooked) * static_cast<double>(left) / static_cast<double>(points_));
    }
    void tell(double done) {
        told_ = done;
        sum_.tell(step_,
                  {done, players_.contexts.rays().total(), players_.contexts.ambient().computed});
    }

    Players players_;
    CachePrepassSum& sum_;
    int step_ = 1;            ///< of the present picture
    std::size_t points_ = 0;  ///< points without a value that its pixels found
    double told_ = 0;
    AmbientRounds rounds_;
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
                                      TakeProgress progress, Group* exchange) {
    const std::vector<int> steps = steps_of(prepass);
    CachePrepassSum sum(steps, progress);
    GroupOfOne alone;
    std::optional<DeterministicPrepass> rounds;
    cache.freeze(false);
    if (prepass == CachePrepass::deterministic) {
        const Players players{tracer,   camera,   cache,
                              executor, contexts, exchange != nullptr ? *exchange : alone,
                              stop};
        rounds.emplace(players, sum);
    }
    bool complete = true;
    for (const int step : steps) {
        const FrameOptions coarse = coarse_options(options, prepass, step);
        if (rounds) {
            complete = rounds->play(coarse);
        } else {
            const auto tell = [&](const FrameProgress& now) { sum.tell(step, now); };
            const Frame frame =
                render_frame(tracer, camera, coarse, executor, contexts, stop, tell);
            sum.add(step, frame.rays, frame.ambient);
            complete = frame.complete;
        }
        if (!complete) break;
    }
    if (rounds && complete) complete = rounds->play_left_out(options);
    if (!complete) cache.freeze(false);
    return sum.result(complete);
}

}  // namespace lightwalk
