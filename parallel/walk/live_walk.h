#pragma once
// A walk that somebody steers: of a new view a frame in time, of a view that rests an ever better
// picture.
#include <memory>
#include <optional>
#include <vector>

#include "core/cloud/progressive_light.h"
#include "core/view/view.h"
#include "core/view/walk_state.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/live_frames.h"
#include "parallel/walk/views_around.h"

namespace lightwalk {

struct LivePicture {
    int width = 0, height = 0;
    std::vector<Rgb> radiance;    ///< rows from the top [W/(m² sr)]
    std::vector<float> distance;  ///< along the pixels' rays [m]
    WalkPhase phase = WalkPhase::moving;
    double share = 0;  ///< of that phase's work that is done, 0 ... 1
    double inferred =
        0;  ///< of the pixels of a view that rests, which have a draft of indirect light
    CloudReport report;
    std::uint64_t rays = 0;  ///< that it took
    bool is_new = true;      ///< false: it is the one before
};

class LiveWalk {
  public:
    /// `frames` must outlive this.
    /// @param samples  rays that a pixel at an edge gets in the end
    LiveWalk(LiveFrames& frames, int samples) : frames_(frames), samples_(samples) {}

    /// The picture of a view: the next better one where it is the view of the call before, and of
    /// its size, or the one before, where it looked around. A new size goes on with what the frames
    /// before have found.
    /// @param budget  after which it should be there, and something of it at least will [s]
    /// Throws what the tracers throw. False: stopped; the picture is the one before.
    [[nodiscard]] bool next(const View& view, int width, int height, WalkAmbient use, double budget,
                            const StopFlag& stop);
    /// Before the first picture: go on from one that is known from elsewhere, of the same scene.
    /// False: nothing is known of it.
    [[nodiscard]] bool recall(const KnownPicture& known, WalkAmbient use, const StopFlag& stop) {
        begin(known.width, known.height, use);
        return frames_.recall(known, stop);
    }
    /// Whether next() also looks around where the view rests, between one better picture and the
    /// next: an eye that turns then sees what is known.
    void look_around(bool does) { looks_around_ = does; }
    /// Whether next() would, of a picture that is done.
    [[nodiscard]] bool has_more_around() const {
        return looks_around_ && around_.next(1, true).has_value();
    }
    /// The scene is another one: pictures of before show nothing of it.
    void begin_anew() {
        around_ = {};
        look_anew();
    }
    /// Show another mixture of the light groups (LiveFrames::keep_groups) from now on.
    /// @return  whether picture() is the last one in this mixture. Else it is still as it was, and
    ///          next() makes a new one, which may be guessed in part
    [[nodiscard]] bool mix(const LightMixture& mixture);
    /// The next picture is one of a new view, also where its view is not: more of it is known now.
    void look_anew();
    /// The last one; empty before the first.
    [[nodiscard]] const LivePicture& picture() const { return picture_; }

  private:
    void begin(int width, int height, WalkAmbient use);
    void resize(int width, int height);
    [[nodiscard]] bool draw(const View& view, bool rests, double budget, const StopFlag& stop);
    [[nodiscard]] std::optional<ViewAside> next_aside(const ProgressivePicture& picture,
                                                      bool adds_light);
    [[nodiscard]] bool look_aside(const ViewAside& aside, double budget, const StopFlag& stop);
    [[nodiscard]] bool draft_light(double budget, const StopFlag& stop);
    void begin_light(const ProgressivePicture& direct);
    [[nodiscard]] bool add_light(double budget, const StopFlag& stop);
    void add_draft();
    void take(std::span<const Rgb> radiance, std::span<const float> distance, bool indirect);

    LiveFrames& frames_;
    int samples_;
    int width_ = 0, height_ = 0;
    WalkAmbient use_ = WalkAmbient::off;
    double refine_ = 0;         ///< see LiveFrames::draw
    std::optional<View> view_;  ///< of the last picture
    bool looks_around_ = false;
    ViewsAround around_;                 ///< the last view that rested
    bool drafting_ = false;              ///< a better draft will come
    const DraftLight* draft_ = nullptr;  ///< of view_; null: there is none
    std::vector<Rgb> undrafted_;         ///< the last picture without it
    std::unique_ptr<ProgressiveLight> progressive_;
    LivePicture picture_;
};

}  // namespace lightwalk
