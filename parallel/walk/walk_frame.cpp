#include "parallel/walk/walk_frame.h"

#include <algorithm>

#include "core/light/small_sources.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {

Frame turned_over(const CloudFrame& drawn, int width, int height, Executor& executor) {
    constexpr int kRowsATask = 32;
    Frame frame;
    frame.width = width;
    frame.height = height;
    frame.radiance.resize(drawn.radiance.size());
    frame.distance.resize(drawn.distance.size());
    const auto copy_row = [&](int y, const auto& from, auto& to) {
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(y) * width, width,
                    to.begin() + static_cast<std::ptrdiff_t>(height - 1 - y) * width);
    };
    const auto tasks = static_cast<std::size_t>((height + kRowsATask - 1) / kRowsATask);
    executor.for_each(tasks, [&](std::size_t task, int) {
        const int first = static_cast<int>(task) * kRowsATask;
        for (int y = first; y < std::min(first + kRowsATask, height); ++y) {
            copy_row(y, drawn.radiance, frame.radiance);
            copy_row(y, drawn.distance, frame.distance);
        }
    });
    return frame;
}

void draw_small_sources(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                        Executor& executor, WorkerContexts& contexts, Frame& frame) {
    if (options.pixels.samples > 1) return;
    const SmallSources sources(tracer, camera, options.width, options.height, 1);
    if (sources.empty()) return;
    const std::vector<Block> blocks = make_blocks(options.whole(), 64);
    executor.for_each(blocks.size(), [&](std::size_t i, int worker) {
        sources.draw(blocks[i], contexts[worker], [&](const SourcePixel& source) {
            const std::size_t at = static_cast<std::size_t>(frame.height - 1 - source.y) *
                                       static_cast<std::size_t>(frame.width) +
                                   static_cast<std::size_t>(source.x);
            blend_source(source, frame.radiance[at],
                         options.use_distances ? &frame.distance[at] : nullptr);
        });
    });
}

WalkFrame draw_walk_frame(CloudFrames& frames, const Tracer& tracer,
                          const VisibilityProbe& visibility, const Camera& camera,
                          const FrameOptions& options, Executor& executor, WorkerContexts& contexts,
                          const StopFlag& stop) {
    contexts.reset_counters();
    SceneCaster caster(tracer, visibility, camera, options, contexts, stop);
    const auto probe = [&](std::span<const PixelPlace> places, std::span<PixelVisibility> seen,
                           int worker) { caster.probe(places, seen, worker); };
    const auto trace = [&](std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                           int sample,
                           int worker) { caster.trace(places, pixels, sample, worker); };
    const CloudFrame& drawn = frames.draw(camera, {probe, trace}, executor, stop);
    WalkFrame result;
    result.frame = turned_over(drawn, options.width, options.height, executor);
    result.report = drawn.report;
    result.causes = drawn.causes;
    if (drawn.complete)
        draw_small_sources(tracer, camera, options, executor, contexts, result.frame);
    result.frame.rays = contexts.rays();
    result.frame.ambient = contexts.ambient();
    result.frame.complete = drawn.complete && !stop.requested();
    return result;
}

}  // namespace lightwalk
