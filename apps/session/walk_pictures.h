#pragma once
// The frames of a walk as pictures, each drawn from the points of those before it.
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "apps/session/picture_maker.h"
#include "apps/session/progress_reporter.h"
#include "apps/session/run_statistics.h"
#include "parallel/walk/live_frames.h"

namespace lightwalk {

/// Frames of another size than the one before start anew.
class WalkPictures : public PictureMaker {
  public:
    /// Everything must outlive this; `statistics` gets what the frames cost.
    /// @param frames   that will be asked for; 0: not known, then each is reported by itself
    /// @param workers  that draw them, for estimates of the time it takes
    WalkPictures(const CloudOptions& options, std::size_t frames, int workers,
                 ProgressListener listener, const StopFlag& stop, RunStatistics& statistics)
        : options_(options),
          frames_wanted_(frames),
          workers_(workers),
          listener_(std::move(listener)),
          stop_(stop),
          statistics_(statistics) {}

    void order(std::shared_ptr<const PictureRequest> request) override {
        requests_.push_back(std::move(request));
    }
    [[nodiscard]] std::optional<Frame> take() override;
    [[nodiscard]] std::size_t ahead() const override { return 1; }

  protected:
    /// Who draws frames with these options.
    [[nodiscard]] virtual std::unique_ptr<LiveFrames> make_frames(const FrameOptions& options) = 0;
    /// Before a frame, the first one of its size or a later one. False: stopped.
    [[nodiscard]] virtual bool prepare(const PictureRequest&, bool /*first*/) { return true; }

    const CloudOptions& options() const { return options_; }

  private:
    void begin_progress(const FrameOptions& options);
    void end_progress(bool complete);

    CloudOptions options_;
    std::size_t frames_wanted_, frames_done_ = 0;
    int workers_;
    ProgressListener listener_;
    const StopFlag& stop_;
    RunStatistics& statistics_;
    std::optional<ProgressReporter> reporter_;  ///< of the whole walk, while it lasts
    std::unique_ptr<LiveFrames> frames_;
    int width_ = 0, height_ = 0;  ///< of the frames at hand
    std::deque<std::shared_ptr<const PictureRequest>> requests_;
};

}  // namespace lightwalk
