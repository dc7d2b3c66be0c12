#include "parallel/frame.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "core/light/small_sources.h"
#include "parallel/blocks.h"
#include "parallel/refine.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {
namespace {

constexpr int kPacketSide = 8;  ///< pixels traced together when every pixel is traced

/// Traces pixels in packets: nearest hits at once, then shading one by one. Scratch of one worker.
class PixelTracer {
  public:
    PixelTracer(const Tracer& tracer, const PixelRays& rays, TraceContext& context,
                const StopFlag& stop)
        : tracer_(tracer), pixel_rays_(rays), context_(context), stop_(stop) {}

    /// Pixels outside the view's domain are black at distance 0.
    void operator()(std::span<const PixelPlace> places, std::span<PixelValue> values) {
        rays_.clear();
        segments_.clear();
        targets_.clear();
        for (std::size_t i = 0; i < places.size(); ++i) {
            values[i] = {};
            const PixelRay pixel = pixel_rays_(places[i].x, places[i].y);
            if (!pixel.ray) continue;
            const double limit = pixel.ray->limit;
            rays_.push_back(
                tracer_.primary(pixel.ray->origin, pixel.ray->direction, limit, pixel.random));
            segments_.push_back(
                {rays_.back().origin, rays_.back().direction, limit > kEpsilon ? limit : kHuge});
            targets_.push_back(i);
        }
        hits_.assign(rays_.size(), Hit{});
        tracer_.scene().geometry().intersect(segments_, hits_);
        for (std::size_t k = 0; k < rays_.size() && !stop_.requested(); ++k) {
            context_.clip_sets.clear();
            context_.scatter_lists.clear();
            tracer_.shade_hit(rays_[k], hits_[k], context_);
            values[targets_[k]] = {rays_[k].value,
                                   static_cast<float>(rays_[k].effective_distance())};
        }
    }

  private:
    const Tracer& tracer_;
    const PixelRays& pixel_rays_;
    TraceContext& context_;
    const StopFlag& stop_;
    std::vector<Ray> rays_;
    std::vector<RaySegment> segments_;
    std::vector<Hit> hits_;
    std::vector<std::size_t> targets_;  ///< into places
};

class FrameRenderer {
  public:
    FrameRenderer(const Tracer& tracer, const Camera& camera, const PixelRays& rays,
                  const FrameOptions& options, Executor& executor, WarningSink& warnings,
                  const StopFlag& stop)
        : tracer_(tracer),
          rays_(rays),
          options_(options),
          executor_(executor),
          stop_(stop),
          contexts_(tracer, warnings, executor.concurrency()),
          counted_(static_cast<std::size_t>(executor.concurrency())) {
        if (rays.pinhole() && options.step == 1)
            small_sources_.emplace(tracer, camera, options.width, options.height,
                                   options.pixels.spacing);
        const std::size_t pixels =
            static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
        frame_.width = options.width;
        frame_.height = options.height;
        frame_.radiance.resize(pixels);
        frame_.distance.resize(pixels);
    }

    Frame run(FunctionRef<void(const FrameProgress&)> progress) {
        const int tile = tile_side();
        const int side = block_side(options_.width, options_.height, executor_.concurrency(), tile);
        const std::vector<Block> blocks = make_blocks(options_.width, options_.height, side);
        executor_.for_each(
            blocks.size(),
            [&](std::size_t i, int worker) {
                render_block(blocks[i], tile, worker);
                report(blocks[i], worker, progress);
            },
            stop_);
        frame_.rays = contexts_.rays();
        frame_.ambient = contexts_.ambient();
        frame_.complete = !stop_.requested();
        return std::move(frame_);
    }

  private:
    [[nodiscard]] int tile_side() const {
        return options_.pixels.spacing > 1 ? refine_tile_side(options_.pixels.spacing)
                                           : kPacketSide;
    }

    void render_block(const Block& block, int tile, int worker) {
        PixelTracer trace(tracer_, rays_, contexts_[worker], stop_);
        for (int y = block.y0; y < block.y1; y += tile) {
            for (int x = block.x0; x < block.x1; x += tile) {
                const Block part{x, y, std::min(x + tile, block.x1), std::min(y + tile, block.y1)};
                if (options_.pixels.spacing > 1)
                    refine(part, trace);
                else
                    trace_all(part, trace);
            }
        }
        if (small_sources_ && !stop_.requested()) draw_small_sources(block, worker);
    }

    void draw_small_sources(const Block& block, int worker) {
        small_sources_->draw(block, contexts_[worker], [&](const SourcePixel& pixel) {
            const std::size_t i = position({pixel.x, pixel.y});
            blend_source(pixel, frame_.radiance[i],
                         options_.use_distances ? &frame_.distance[i] : nullptr);
        });
    }

    void trace_all(const Block& tile, PixelTracer& trace) {
        std::array<PixelPlace, kPacketSide * kPacketSide> places;
        std::array<PixelValue, kPacketSide * kPacketSide> values;
        std::size_t count = 0;
        for (int y = tile.y1; y-- > tile.y0;) {  // from the top
            for (int x = tile.x0; x < tile.x1; ++x) places[count++] = {x, y};
        }
        trace({places.data(), count}, {values.data(), count});
        for (std::size_t i = 0; i < count; ++i) store(places[i], values[i]);
    }

    void refine(const Block& tile, PixelTracer& trace) {
        const RefineOptions options{options_.pixels.spacing, options_.pixels.threshold,
                                    options_.use_distances};
        refine_tile(
            tile, options, trace,
            [this](const PixelPlace& place, const PixelValue& value) { store(place, value); });
    }

    [[nodiscard]] std::size_t position(const PixelPlace& place) const {
        const std::size_t row = static_cast<std::size_t>(options_.height - 1 - place.y);
        return row * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(place.x);
    }

    /// Each pixel is stored by one task only.
    void store(const PixelPlace& place, const PixelValue& value) {
        const std::size_t i = position(place);
        frame_.radiance[i] = value.radiance;
        frame_.distance[i] = value.distance;
    }

    void report(const Block& block, int worker, FunctionRef<void(const FrameProgress&)> progress) {
        std::uint64_t& counted = counted_[static_cast<std::size_t>(worker)];
        const std::uint64_t now = contexts_[worker].counters.total();
        rays_done_ += now - counted;
        counted = now;
        pixels_done_ += block.pixels();
        const std::unique_lock lock(progress_mutex_, std::try_to_lock);
        if (!lock) return;  // the next one will tell
        const double done =
            static_cast<double>(pixels_done_) / static_cast<double>(frame_.radiance.size());
        progress({done, rays_done_});
    }

    const Tracer& tracer_;
    const PixelRays& rays_;
    const FrameOptions& options_;
    Executor& executor_;
    const StopFlag& stop_;
    WorkerContexts contexts_;
    Frame frame_;
    std::optional<SmallSources> small_sources_;  ///< nothing when the picture is blurred
    std::vector<std::uint64_t> counted_;         ///< rays reported so far, by worker
    std::atomic<std::uint64_t> rays_done_{0};
    std::atomic<std::size_t> pixels_done_{0};
    std::mutex progress_mutex_;
};

}  // namespace

Frame render_frame(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                   Executor& executor, WarningSink& warnings, const StopFlag& stop,
                   FunctionRef<void(const FrameProgress&)> progress) {
    const PixelRays rays(camera, options.previous, options.width, options.height, options.pixels,
                         options.seed, options.step);
    FrameOptions coarse = options;
    coarse.width = (options.width + options.step - 1) / options.step;
    coarse.height = (options.height + options.step - 1) / options.step;
    return FrameRenderer(tracer, camera, rays, coarse, executor, warnings, stop).run(progress);
}

}  // namespace lightwalk
