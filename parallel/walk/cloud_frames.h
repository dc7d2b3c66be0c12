#pragma once
// Frames of a walk: each is drawn from the points that those before it left, and what they cannot
// answer truthfully is traced.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/primary_visibility.h"
#include "core/cloud/progressive.h"
#include "core/cloud/reuse_error_controller.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_frame.h"
#include "parallel/walk/cloud_region.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {

/// The cloud and its frames. Without a budget a frame is a function of the views so far: the same
/// bytes with any executor. It knows nothing of scenes: whoever can say what a pixel's ray meets
/// can use it.
class CloudFrames {
  public:
    /// @param first  number of the first frame: the audits of frames with the same number choose
    /// the
    ///               same pixels
    CloudFrames(int width, int height, const CloudOptions& options, std::uint64_t first = 0);

    /// The next frame. Throws what the caster throws; then, and when stopped, the cloud is as it
    /// was before. The frame is there until the next one is drawn.
    [[nodiscard]] const CloudFrame& draw(const Camera& camera, const PixelCaster& caster,
                                         Executor& executor, const StopFlag& stop);

    [[nodiscard]] std::span<const CloudPoint> points() const { return region_.points(); }
    /// The last frame as one to be refined; nothing before the first one, and without `refine`.
    [[nodiscard]] const ProgressivePicture* progressive();
    /// Time for each of the next frames; 0: none is too long [s].
    void set_budget(double seconds) { options_.budget = seconds; }
    /// Share of the pixels that a frame refines at most; above 0. Choosing them takes time, too.
    void set_refine(double share) { options_.refine = share; }

  private:
    struct Step;
    void plan_refinement(Step& step);
    void trace(Step& step);
    void show(Executor& executor);
    void begin_progressive();
    void refine(Step& step);

    int width_, height_;
    CloudOptions options_;
    CloudRegion region_;  ///< the whole picture
    ReuseErrorController error_controller_;
    std::uint64_t frame_;
    double last_keep_seconds_ = 0;  ///< of the frame before
    // With `refine`: the last frame.
    std::optional<View> view_;
    bool begun_ = false;  ///< to be refined: what follows is of it
    ProgressivePicture progressive_;
    std::vector<float> distance_;
};

}  // namespace lightwalk
