#pragma once
// One frame: every pixel of a view, by all workers of an executor.
#include <cstdint>
#include <vector>

#include "core/math/function_ref.h"
#include "core/transport/tracer.h"
#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/pixel_rays.h"

namespace lightwalk {

struct FrameOptions {
    int width = 512, height = 512;  ///< [pixels]
    PixelOptions pixels;
    std::uint64_t seed = 0;
    bool use_distances =
        false;  ///< they count in refinement and in drawing small sources (rpict -z)
    const Camera* previous = nullptr;  ///< view of the frame before, for motion blur
    int step = 1;  ///< more: trace one pixel out of step x step; the frame is so much smaller
};

/// Rows from the top, left to right.
struct Frame {
    int width = 0, height = 0;
    std::vector<Rgb> radiance;  ///< [W/(m² sr)]
    std::vector<float>
        distance;  ///< along the pixel's ray, 1e10 for nothing, 0 where there is no ray [m]
    RayCounters rays;
    AmbientCounters ambient;
    bool complete = false;  ///< false: stopped early; then some pixels are black
};

struct FrameProgress {
    double done = 0;         ///< share of the pixels, 0 ... 1
    std::uint64_t rays = 0;  ///< traced so far
};

/// Render; light sources too small for the pixel grid are drawn in with their coverage (unless a
/// lens or motion blurs the picture). The same options give the same bytes with any executor and
/// any number of workers.
/// @param stop      ends the work within about the time of one pixel
/// @param progress  called after blocks, by whichever worker finished one, but never twice at once
/// Throws what the tracer throws (InputError for errors that only show while shading).
[[nodiscard]] Frame render_frame(const Tracer& tracer, const Camera& camera,
                                 const FrameOptions& options, Executor& executor,
                                 WarningSink& warnings, const StopFlag& stop,
                                 FunctionRef<void(const FrameProgress&)> progress);

}  // namespace lightwalk
