#pragma once
// Renders blocks of a picture.
#include <cstddef>
#include <optional>
#include <vector>

#include "core/light/small_sources.h"
#include "core/trace/tracer.h"
#include "core/view/pixel_rays.h"
#include "core/view/pixels.h"
#include "parallel/blocks.h"
#include "parallel/frame_options.h"
#include "parallel/pixel_tracer.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// The finished pixels of a block: row by row from its bottom, left to right.
struct BlockPixels {
    Block block;
    std::vector<PixelValue> values;
    std::vector<PixelHit> hits;    ///< empty unless asked for
    std::vector<Rgb> groups = {};  ///< by pixel, then light group; empty unless asked for

    [[nodiscard]] std::size_t index(const PixelPlace& place) const { return block.index(place); }
};

/// Renders any block of a picture, including refinement and small light sources. Deterministic:
/// pixels are the same bytes for any division into blocks, window or number of workers (with
/// indirect light: as far as the ambient cache gives the same answers).
class BlockRenderer {
  public:
    /// The arguments, and options.previous, must outlive this; `stop` ends a block within about the
    /// time of one pixel.
    BlockRenderer(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                  WorkerContexts& contexts, const StopFlag& stop);

    [[nodiscard]] const FrameOptions& options() const { return options_; }
    [[nodiscard]] WorkerContexts& contexts() const { return contexts_; }

    /// Blocks whose corners are multiples of this number, or lie at the picture's edge, are
    /// cheapest: other blocks trace pixels beyond their edges.
    [[nodiscard]] int alignment() const;

    /// Render `block`, which lies inside the picture. False: stopped; then `pixels` is not whole.
    /// Workers may render at the same time. Throws what the tracer throws (InputError for errors
    /// that only show while shading).
    [[nodiscard]] bool render(const Block& block, int worker, BlockPixels& pixels) const;

  private:
    [[nodiscard]] bool shares_samples() const;
    void trace_all(PixelTracer& trace, BlockPixels& pixels) const;
    void filter_samples(PixelTracer& trace, BlockPixels& pixels) const;
    void refine(PixelTracer& trace, BlockPixels& pixels) const;
    void draw_small_sources(int worker, BlockPixels& pixels) const;

    const Tracer& tracer_;
    FrameOptions options_;
    PixelRays rays_;
    WorkerContexts& contexts_;
    const StopFlag& stop_;
    std::optional<SmallSources>
        small_sources_;  ///< nothing when the picture is blurred or has several samples a pixel
};

}  // namespace lightwalk
