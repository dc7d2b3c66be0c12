#pragma once
// A walk that somebody steers: of a new view a frame in time, of a view that rests an ever better
// picture.
#include <memory>
#include <optional>
#include <vector>

#include "core/cloud/scene_sights.h"
#include "core/transport/tracer.h"
#include "parallel/executor.h"
#include "parallel/frame.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/resting_light.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// When indirect light is traced.
enum class AmbientUse {
    off,
    rest,  ///< while the view rests
    always,
};

/// What is being done to the picture.
enum class LivePhase {
    moving,    ///< the view is new
    filling,   ///< pixels that were guessed or carried on are traced
    ambient,   ///< indirect light is added
    refining,  ///< edges get more rays
    done,      ///< it is as good as it gets
};

struct LivePicture {
    int width = 0, height = 0;
    std::vector<Rgb> radiance;    ///< rows from the top [W/(m² sr)]
    std::vector<float> distance;  ///< along the pixels' rays [m]
    LivePhase phase = LivePhase::moving;
    double share = 0;  ///< of that phase's work that is done, 0 ... 1
    CloudReport report;
    RayCounters rays;  ///< that it took
};

class LiveWalk {
  public:
    /// All must outlive this.
    /// @param ambient  knows indirect light; null: there is none
    /// @param options  of all pictures, but for their size; `cloud.refine` does not
    ///                 count
    LiveWalk(const Tracer& direct, const Tracer* ambient, const CloudOptions& cloud,
             const FrameOptions& options, Executor& executor, WarningSink& warnings);

    /// The picture of a view: the next better one where it is the view of the call before.
    /// @param budget  after which it should be there, and something of it at least will [s]
    /// Throws what the tracers throw. When stopped the picture may be empty.
    [[nodiscard]] LivePicture next(const View& view, int width, int height, AmbientUse use,
                                   double budget, const StopFlag& stop);

  private:
    /// A tracer and what goes with it.
    struct Light {
        Light(const Tracer& its_tracer, WarningSink& warnings, int workers)
            : tracer(its_tracer), sights(its_tracer), contexts(its_tracer, warnings, workers) {}
        const Tracer& tracer;
        SceneSights sights;
        WorkerContexts contexts;
    };

    void begin(int width, int height, AmbientUse use);
    [[nodiscard]] LivePicture draw(const View& view, bool rests, const StopFlag& stop);
    [[nodiscard]] LivePicture add_light(double budget, const StopFlag& stop);
    [[nodiscard]] LivePicture unchanged() const;
    [[nodiscard]] bool adds_light() const { return use_ == AmbientUse::rest && full_ != nullptr; }

    CloudOptions cloud_;
    FrameOptions options_;
    Executor& executor_;
    std::unique_ptr<Light> direct_, full_;  ///< full_: with indirect light, or null
    Light* walking_ = nullptr;              ///< of the frames
    AmbientUse use_ = AmbientUse::off;
    std::unique_ptr<CloudFrames> frames_;
    std::optional<View> view_;  ///< of the last picture
    std::unique_ptr<RestingLight> resting_;
    LivePicture last_;  ///< of the view, without indirect light while `resting_` adds it
};

}  // namespace lightwalk
