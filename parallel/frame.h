#pragma once
// Rendering of a frame: every pixel of a view, or of a window of it, by all workers of an executor.
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/function_ref.h"
#include "core/trace/tracer.h"
#include "core/view/view.h"
#include "parallel/block_renderer.h"
#include "parallel/blocks.h"
#include "parallel/checkpoint_sink.h"
#include "parallel/executor.h"
#include "parallel/frame_options.h"
#include "parallel/progress.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// A rendered picture; rows from the top, left to right.
struct Frame {
    int width = 0, height = 0;
    std::vector<Rgb> radiance;  ///< [W/(m² sr)]
    std::vector<float>
        distance;  ///< along the pixel's (first) ray, 1e10 for nothing, 0 where there is no ray [m]
    std::vector<PixelHit> hits;            ///< empty unless asked for
    std::vector<std::vector<Rgb>> groups;  ///< of the radiance, what each light group adds; empty
                                           ///< unless the contexts have them
    std::vector<Rgb> half;     ///< radiance of half of the samples; empty unless there is `error`
    std::vector<float> error;  ///< relative, of luminance, as estimated; empty unless asked for
    RayCounters rays;
    AmbientCounters ambient;
    bool complete = false;  ///< false: stopped early; then some blocks are black
};

/// Takes a finished block from the worker that rendered it; called by many workers at once.
using TakeBlock = FunctionRef<void(const BlockPixels& pixels, int worker)>;

/// Render blocks by all workers, until `stop` (the renderer's own) is requested. Only whole blocks
/// are handed on. The first exception ends the others' work after their block and is thrown again
/// here.
void render_blocks(const BlockRenderer& renderer, std::span<const Block> blocks, Executor& executor,
                   const StopFlag& stop, TakeBlock take);

/// Render a frame. Light sources smaller than a pixel are drawn by their coverage (unless a lens or
/// motion blurs the picture, or pixels have several samples, which find them). Deterministic: the
/// same options give the same bytes with any executor and number of workers, and windows equal the
/// parts of the whole picture.
/// @param contexts  one for each worker of the executor, made for `tracer`; their counters start
///                  from zero
/// @param stop      ends the work within about the time of one pixel
/// @param checkpoint    null: none. Blocks that it knows are not rendered again; the others are
/// stored in it
/// @param progress  called after blocks, by whichever worker finished one, but never twice at once
/// Throws what the tracer throws (InputError for errors that only show while shading).
[[nodiscard]] Frame render_frame(const Tracer& tracer, const Camera& camera,
                                 const FrameOptions& options, Executor& executor,
                                 WorkerContexts& contexts, const StopFlag& stop,
                                 TakeProgress progress, CheckpointSink* checkpoint = nullptr);

}  // namespace lightwalk
