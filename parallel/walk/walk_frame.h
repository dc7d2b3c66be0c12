#pragma once
// A frame of a walk through a scene.
#include "core/cloud/visibility_probe.h"
#include "core/trace/tracer.h"
#include "parallel/frame.h"
#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

/// A frame, and what it took.
struct WalkFrame {
    Frame frame;
    CloudReport report;
    std::vector<TraceCause> causes;  ///< by pixel, row by row from the bottom
};

/// Draw the next frame of a walk: the picture that render_frame makes of the same view when it
/// traces every pixel, as far as the points of the frames before it tell the truth; the first frame
/// is that to the bit. Light sources too small for the pixel grid are drawn in with their coverage.
/// @param frames    of the picture's size
/// @param options   without lens, motion, window and step; the spacing does not count
/// @param contexts  one for each worker of the executor; their counters start from zero
/// Throws what the tracer throws.
[[nodiscard]] WalkFrame draw_walk_frame(CloudFrames& frames, const Tracer& tracer,
                                        const VisibilityProbe& visibility, const Camera& camera,
                                        const FrameOptions& options, Executor& executor,
                                        WorkerContexts& contexts, const StopFlag& stop);

/// The picture of a drawn frame, with its rows from the top.
[[nodiscard]] Frame turned_over(const CloudFrame& drawn, int width, int height, Executor& executor);

/// Draw light sources that are too small for the pixel grid into a frame, with their coverage: they
/// are no part of the points, for they cover more or less of a pixel from frame to frame.
void draw_small_sources(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                        Executor& executor, WorkerContexts& contexts, Frame& frame);

}  // namespace lightwalk
