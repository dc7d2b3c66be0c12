#pragma once
// Who draws what a walk that is steered wants: the threads of this process, or many ranks.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/cloud/shown_materials.h"
#include "core/cloud/visibility_probe.h"
#include "core/trace/tracer.h"
#include "parallel/executor.h"
#include "parallel/frame.h"
#include "parallel/frame_options.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/first_light.h"
#include "parallel/walk/known_picture.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// A frame, and what it took.
struct WalkFrame {
    Frame frame;
    CloudReport report;
};

/// A tracer of a scene, and what goes with it.
struct WalkLight {
    WalkLight(const Tracer& its_tracer, WarningSink& warnings, int workers)
        : tracer(its_tracer), visibility(its_tracer), contexts(its_tracer, warnings, workers) {}
    const Tracer& tracer;
    VisibilityProbe visibility;
    WorkerContexts contexts;
};

class LiveFrames {
  public:
    /// All must outlive this.
    /// @param indirect  knows indirect light; null: there is none
    /// @param options   of all pictures, but for their size; without lens, motion, window and step;
    ///                  the spacing does not count
    LiveFrames(const Tracer& direct, const Tracer* indirect, const CloudOptions& cloud,
               const FrameOptions& options, Executor& executor, WarningSink& warnings);
    virtual ~LiveFrames() = default;
    LiveFrames(const LiveFrames&) = delete;
    LiveFrames& operator=(const LiveFrames&) = delete;

    /// Keep by groups of emitters what they bring, so that they may be dimmed: points and pixels at
    /// rest are then mixed anew, and nothing is traced. Before begin().
    void keep_groups(const std::shared_ptr<const LightGroups>& groups);
    /// Null: they are not kept.
    [[nodiscard]] const std::shared_ptr<const LightGroups>& light_groups() const {
        return direct_->contexts.shared_groups();
    }
    /// Of the light groups from here on.
    /// @return  the last frame in this mixture, without small light sources, where all its pixels
    ///          are traced; null: the next frame is drawn as one of a new view
    [[nodiscard]] const ProgressivePicture* mix(LightMixture mixture) {
        mixture_ = std::move(mixture);
        if (draft_) draft_->mix(mixture_);
        return mixed();
    }

    /// The scene is another one from here on: of other modifiers, sources or surfaces. Frames keep
    /// their size and their light, and the points of the frames before are outdated. The tracers of
    /// before are not used any more.
    /// @param direct, indirect  as they were given to the constructor
    /// @param groups            null: they are not kept
    void change(const Tracer& direct, const Tracer* indirect,
                const std::shared_ptr<const LightGroups>& groups, WarningSink& warnings);

    /// The next change() outdates only the points that may show these; nothing: all.
    void outdate_only(std::optional<ShownMaterials> materials) { outdated_ = std::move(materials); }
    [[nodiscard]] const std::optional<ShownMaterials>& outdated() const { return outdated_; }
    /// Share of the points that the last change() has kept.
    [[nodiscard]] double kept_points() const { return kept_; }

    /// Of the frames.
    [[nodiscard]] const FrameOptions& options() const { return options_; }
    /// Whether there is indirect light to be traced.
    [[nodiscard]] bool has_indirect() const { return indirect_ != nullptr; }
    /// Frames of this size from here on, and of this light: what was carried on is forgotten.
    /// @param indirect  only where there is some
    /// @param first     number of the first one, see FrameLead
    void begin(int width, int height, bool indirect, std::uint64_t first = 0);

    // After that; all throw what the tracers throw.

    /// What is known of the last frame, where its view rests: for recall(), in another process.
    /// Nothing: there is none, or nothing can be recalled.
    [[nodiscard]] virtual std::optional<KnownPicture> known() const { return std::nullopt; }
    /// Before the first frame, of this picture's size and light: it leaves points as if it had been
    /// drawn, of a scene in the same state. False: it does not.
    [[nodiscard]] virtual bool recall(const KnownPicture& /*known*/, const StopFlag& /*stop*/) {
        return false;
    }

    /// Frames of another size from here on, of the same light: what is known of the scene stays,
    /// but the next frame is no longer that of render_frame to the bit.
    void resize(int width, int height);

    /// The next frame is drawn as one of a new view, also where its view is not: of what it shows
    /// more is known by now.
    virtual void forget_view() = 0;

    /// The next frame of a walk: the picture that render_frame makes of the same view when it
    /// traces every pixel, as far as the points of the frames before it tell the truth; the first
    /// frame is that to the bit.
    /// @param budget  see CloudOptions
    /// @param refine  the same
    [[nodiscard]] virtual WalkFrame draw(const View& view, double budget, double refine,
                                         const StopFlag& stop) = 0;
    /// A frame of another view, for the points that it leaves: an eye that comes to look there
    /// finds them. The last frame, and its points, are as if there had been none. Only after
    /// progressive() was called for it.
    /// @return  share of its pixels that there was no time for; nothing: stopped
    [[nodiscard]] std::optional<double> look_aside(const View& view, int width, int height,
                                                   double budget, const StopFlag& stop);
    /// How good the pixels of the last frame are, if the next one has the same view. Null: there is
    /// none, or it was stopped.
    [[nodiscard]] virtual const ProgressivePicture* progressive(const StopFlag& stop) = 0;
    /// Pixels by all light there is.
    /// @param seconds  after which no more are begun, but some are at once
    [[nodiscard]] virtual TracedValues trace(const View& view, const ProgressiveWork& work,
                                             double seconds, const StopFlag& stop) = 0;
    /// A draft of what indirect light adds to the pixels of a view, in pictures of this size; it is
    /// there until that of another one is asked for. By the executor alone, wherever frames are
    /// drawn: it is small, and its rough values are of use to no other picture.
    /// @param seconds  of work at it
    [[nodiscard]] ViewDraft draft(const View& view, double seconds, const StopFlag& stop);
    /// See draw_small_sources(); by all light there is.
    /// @param indirect  false: by the light of the frames
    void add_small_sources(const View& view, Frame& frame, bool indirect = true);
    /// That the last frame took, or the last pixels.
    [[nodiscard]] std::uint64_t rays() const { return rays_; }

  protected:
    /// See mix().
    [[nodiscard]] virtual const ProgressivePicture* mixed() { return nullptr; }
    /// See change().
    /// @param only  points that may show these; null: all
    /// @return      share of the points that are kept
    virtual double outdate(const ShownMaterials* /*only*/) { return 0; }
    /// Put the last frame away (see FrameLead), and take it back.
    virtual void put_aside() = 0;
    virtual void take_back() = 0;
    /// The frames that begin() has announced.
    virtual void start(std::uint64_t first) = 0;
    /// The frames that follow are of the size in options_.
    virtual void resized() = 0;

    CloudOptions cloud_;
    FrameOptions options_;
    Executor& executor_;
    std::unique_ptr<WalkLight> direct_, indirect_;  ///< indirect_: knows both, or is null
    std::unique_ptr<FirstLight> draft_;             ///< of this light; null: not asked for yet
    WalkLight* walking_ = nullptr;                  ///< of the frames
    LightMixture mixture_;                          ///< of the light groups
    std::optional<ShownMaterials> outdated_;        ///< see outdate_only
    double kept_ = 0;                               ///< see kept_points
    std::uint64_t rays_ = 0;
};

/// Pixels of a picture by the threads of an executor; see LiveFrames::trace.
/// @param options   of the picture: one sample a pixel, no window
/// @param contexts  made for `tracer`, one for each worker; their counters start from zero
/// @param mixture   of their light groups, where they have some
[[nodiscard]] TracedValues trace_pixels(const Tracer& tracer, WorkerContexts& contexts,
                                        const Camera& camera, const FrameOptions& options,
                                        const ProgressiveWork& work, double seconds,
                                        Executor& executor, const StopFlag& stop,
                                        const LightMixture& mixture = {});

/// The picture of a drawn frame, with its rows from the top.
[[nodiscard]] Frame turned_over(const CloudFrame& drawn, Executor& executor);

/// Draw light sources that are too small for the pixel grid into a frame, with their coverage: they
/// are no part of the points, for they cover more or less of a pixel from frame to frame.
/// @param samples  most rays of a pixel at rest; 0: the view moves, and pixels may be of any ray
void draw_small_sources(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                        Executor& executor, WorkerContexts& contexts, Frame& frame, int samples,
                        const LightMixture& mixture = {});

/// Frames by the threads of this process.
class LocalFrames final : public LiveFrames {
  public:
    using LiveFrames::LiveFrames;
    void forget_view() override { frames_->forget_view(); }
    [[nodiscard]] WalkFrame draw(const View& view, double budget, double refine,
                                 const StopFlag& stop) override;
    [[nodiscard]] const ProgressivePicture* progressive(const StopFlag&) override {
        return frames_->progressive();
    }
    [[nodiscard]] TracedValues trace(const View& view, const ProgressiveWork& work, double seconds,
                                     const StopFlag& stop) override;

  private:
    double outdate(const ShownMaterials* only) override;
    void start(std::uint64_t first) override;
    void resized() override { frames_->resize(options_.width, options_.height); }
    void put_aside() override { resting_ = frames_->put_aside(); }
    void take_back() override { frames_->take_back(*std::exchange(resting_, std::nullopt)); }

    [[nodiscard]] const ProgressivePicture* mixed() override;

    std::unique_ptr<CloudFrames> frames_;
    std::optional<FrameLead::Resting> resting_;  ///< that was put aside
};

}  // namespace lightwalk
