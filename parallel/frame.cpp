#include "parallel/frame.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <mutex>

#include "core/transport/light_groups.h"
#include "parallel/shared_blocks.h"

namespace lightwalk {
namespace {

/// Sums the progress of all workers and reports it.
class ProgressSum {
  public:
    ProgressSum(const WorkerContexts& contexts, std::size_t pixels, TakeProgress progress)
        : pixels_(pixels),
          progress_(progress),
          counted_(static_cast<std::size_t>(contexts.size())) {}

    void add(std::size_t pixels, int worker, const TraceContext& context) {
        Counted& counted = counted_[static_cast<std::size_t>(worker)];
        const Counted now{context.counters.rays.total(), context.counters.ambient.computed};
        rays_done_ += now.rays - counted.rays;
        values_done_ += now.values - counted.values;
        pixels_done_ += pixels;
        counted = now;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) return;  // the next report includes this one
        progress_({static_cast<double>(pixels_done_) / static_cast<double>(pixels_), rays_done_,
                   values_done_});
    }

  private:
    struct Counted {
        std::uint64_t rays = 0, values = 0;
    };
    std::size_t pixels_;
    TakeProgress progress_;
    std::vector<Counted> counted_;  ///< included so far, by worker
    std::atomic<std::uint64_t> rays_done_{0}, values_done_{0};
    std::atomic<std::size_t> pixels_done_{0};
    std::mutex mutex_;
};

/// Make `values` of `count` zeros. The system clears a page when it is first touched, which takes
/// longer than all else that happens to it here, so all threads share that.
template <typename T>
void resize_by_all(std::vector<T>& values, std::size_t count, Executor& executor) {
    constexpr std::size_t kPage = 4096, kPart = std::size_t{1} << 21;  // 2 MB: a large page
    values.reserve(count);
    const std::size_t size = count * sizeof(T);
    if (executor.concurrency() > 1 && size > kPart) {
        auto* const bytes = reinterpret_cast<unsigned char*>(values.data());
        executor.for_each((size + kPart - 1) / kPart, [&](std::size_t part, int /*worker*/) {
            const std::size_t end = std::min(size, (part + 1) * kPart);
            for (std::size_t at = part * kPart; at < end; at += kPage) bytes[at] = 0;
        });
    }
    values.resize(count);
}

Frame black_frame(const FrameOptions& options, std::size_t groups, Executor& executor) {
    const PixelRectangle area = options.area();
    Frame frame;
    frame.width = area.width();
    frame.height = area.height();
    resize_by_all(frame.radiance, area.pixels(), executor);
    resize_by_all(frame.distance, area.pixels(), executor);
    if (options.hits) resize_by_all(frame.hits, area.pixels(), executor);
    frame.groups.resize(groups);
    for (std::vector<Rgb>& group : frame.groups) resize_by_all(group, area.pixels(), executor);
    return frame;
}

/// Blocks do not overlap, so that many may be stored at once.
void store(const BlockPixels& pixels, const PixelRectangle& area, Frame& frame) {
    const Block& block = pixels.block;
    for (int y = block.y0; y < block.y1; ++y) {
        const auto row = static_cast<std::size_t>(area.y1 - 1 - y);
        std::size_t to = row * static_cast<std::size_t>(area.width()) +
                         static_cast<std::size_t>(block.x0 - area.x0);
        std::size_t from = pixels.index({block.x0, y});
        for (int x = block.x0; x < block.x1; ++x, ++from, ++to) {
            frame.radiance[to] = pixels.values[from].radiance;
            frame.distance[to] = pixels.values[from].distance;
            if (!frame.hits.empty()) frame.hits[to] = pixels.hits[from];
            for (std::size_t g = 0; g < frame.groups.size(); ++g)
                frame.groups[g][to] = pixels.groups[from * frame.groups.size() + g];
        }
    }
}

/// Copies blocks known from a checkpoint into the frame; returns the blocks left to render.
std::vector<Block> take_known(CheckpointSink& checkpoint, const std::vector<Block>& wanted,
                              int alignment, const PixelRectangle& area, Frame& frame) {
    std::vector<PixelRectangle> known;
    for (const BlockPixels& pixels : checkpoint.known()) {
        store(pixels, area, frame);
        known.push_back(pixels.block);
    }
    return blocks_left(wanted, known, alignment);
}

/// Pixels of a coarse picture, each by itself: there are few blocks, of which each takes long where
/// its pixels fill an ambient cache, so that workers would wait for the last one.
void render_pixels(const BlockRenderer& renderer, std::span<const Block> blocks, Executor& executor,
                   const StopFlag& stop, TakeBlock take) {
    SharedBlocks shared(blocks, renderer.alignment(), executor.concurrency());
    std::vector<BlockPixels> pixels(static_cast<std::size_t>(executor.concurrency()));
    executor.for_each(
        shared.pixels(),
        [&](std::size_t, int worker) {
            BlockPixels& own = pixels[static_cast<std::size_t>(worker)];
            const PixelPlace at = shared.next(worker);
            if (renderer.render({at.x, at.y, at.x + 1, at.y + 1}, worker, own)) take(own, worker);
        },
        stop);
}

}  // namespace

void render_blocks(const BlockRenderer& renderer, std::span<const Block> blocks, Executor& executor,
                   const StopFlag& stop, TakeBlock take) {
    std::vector<BlockPixels> pixels(static_cast<std::size_t>(executor.concurrency()));
    executor.for_each(
        blocks.size(),
        [&](std::size_t i, int worker) {
            BlockPixels& own = pixels[static_cast<std::size_t>(worker)];
            if (renderer.render(blocks[i], worker, own)) take(own, worker);
        },
        stop);
}

Frame render_frame(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                   Executor& executor, WorkerContexts& contexts, const StopFlag& stop,
                   TakeProgress progress, CheckpointSink* checkpoint) {
    assert(contexts.size() >= executor.concurrency());
    const PixelRectangle area = options.area();
    assert(area.x0 >= 0 && area.x1 <= options.whole().x1);
    assert(area.y0 >= 0 && area.y1 <= options.whole().y1);
    const LightGroups* const groups = contexts.light_groups();
    Frame frame = black_frame(options, groups ? groups->size() : 0, executor);
    contexts.reset_counters();
    const BlockRenderer renderer(tracer, camera, options, contexts, stop);
    const int side =
        block_side(area.width(), area.height(), executor.concurrency(), renderer.alignment());
    std::vector<Block> blocks = make_blocks(area, side);
    if (checkpoint != nullptr)
        blocks = take_known(*checkpoint, blocks, renderer.alignment(), area, frame);
    std::size_t pixels_wanted = 0;
    for (const Block& block : blocks) pixels_wanted += block.pixels();
    ProgressSum sum(contexts, pixels_wanted, progress);
    const auto take = [&](const BlockPixels& pixels, int worker) {
        store(pixels, area, frame);
        if (checkpoint != nullptr) checkpoint->keep(pixels);
        sum.add(pixels.block.pixels(), worker, contexts[worker]);
    };
    const bool coarse = options.step > 1 && executor.concurrency() > 1;
    (coarse ? render_pixels : render_blocks)(renderer, blocks, executor, stop, take);
    frame.rays = contexts.rays();
    frame.ambient = contexts.ambient();
    frame.complete = !stop.requested();
    return frame;
}

}  // namespace lightwalk
