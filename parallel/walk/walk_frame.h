#pragma once
// A frame of a walk through a scene.
#include "core/cloud/scene_sights.h"
#include "core/transport/tracer.h"
#include "parallel/frame.h"
#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

/// A frame, and what it took.
struct WalkFrame {
    Frame frame;
    CloudReport report;
    std::vector<HoleCause> causes;  ///< by pixel, row by row from the bottom
};

/// Draw the next frame of a walk: the picture that render_frame makes of the same view when it
/// traces every pixel, as far as the points of the frames before it tell the truth; the first frame
/// is that to the bit. Light sources too small for the pixel grid are drawn in with their coverage.
/// @param frames    of the picture's size
/// @param options   without lens, motion, window and step; the spacing does not count
/// @param contexts  one for each worker of the executor; their counters start from zero
/// Throws what the tracer throws.
[[nodiscard]] WalkFrame draw_walk_frame(CloudFrames& frames, const Tracer& tracer,
                                        const SceneSights& sights, const Camera& camera,
                                        const FrameOptions& options, Executor& executor,
                                        WorkerContexts& contexts, const StopFlag& stop);

}  // namespace lightwalk
