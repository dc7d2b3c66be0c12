#pragma once
// A scene in which somebody walks: its pictures, its light, and what browsers are told of both.
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/session/scene_session.h"
#include "apps/walk/clean_view.h"
#include "apps/walk/client_inbox.h"
#include "apps/walk/kept_picture.h"
#include "apps/walk/material_edits.h"
#include "apps/walk/scene_follower.h"
#include "apps/walk/scene_state.h"
#include "apps/walk/walk_answers.h"
#include "apps/walk/walk_glare.h"
#include "apps/walk/walk_isolux.h"
#include "apps/walk/walk_screen.h"
#include "apps/walk/walk_time.h"
#include "core/cloud/moving_size.h"
#include "core/plan/floor_plan.h"
#include "parallel/executor_task_runner.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// What a walk begins with that is not as its scene was read.
struct WalkStart {
    SceneState state;
    CheckedEdits edits;
    TimeRequest time;          ///< that are shown by the state
    EditsRequest edits_asked;  ///< the same
};

struct RenderLoopOptions {
    double rate = 30;      ///< frames while the view moves [1/s]
    int edge_samples = 8;  ///< rays a pixel at an edge gets at rest
    std::string history;   ///< the command line, for headers of pictures that are saved
    int ranks = 1;         ///< that draw it, for the page's numbers
    /// Changes the scene under the frames (RenderBackend::change); returns the session that
    /// it has from then on. Throws InputError, and leaves all as it was. None: it cannot be
    /// changed.
    std::function<const SceneSession&(const ModelChange& change)> change = {};
    WalkStart start = {};  ///< what the session shows of its model
    /// Puts another scene in its place, likewise.
    std::function<const SceneSession&(const std::shared_ptr<const CompiledScene>& scene)> replace =
        {};
    /// For who begins anew where this process is lost. Null: nobody will.
    std::shared_ptr<const KeptPicture> kept = {};
    /// Denoises what is shown of a view that rests, where the page wants it. None: nothing does.
    PictureCleaner::Denoise denoise = {};
};

/// Draws until it is told to stop. For one thread.
class RenderLoop {
  public:
    /// All must outlive this.
    /// @param home  where the walk begins, which tells how high eyes are
    RenderLoop(RenderLoopOptions options, const SceneSession& session, const View& home,
               LiveFrames& frames, Executor& executor, WarningSink& warnings,
               ClientInbox& client_inbox, WalkScreen& screen);

    static constexpr std::chrono::milliseconds kMoment{100};
    /// Answer what has come, and draw the next picture, if there is one to draw; otherwise wait for
    /// a moment.
    /// @param longest  of that moment
    void step(const StopFlag& stop, std::chrono::milliseconds longest = kMoment);
    /// How long a step may wait for something to do.
    [[nodiscard]] std::chrono::milliseconds patience() const;
    /// Another loop draws in turn with this one, which has that share of the time from now on.
    void share_time(double share) { share_ = share; }

    /// What is wished for, and seen: where the eye keeps its height it is there already.
    [[nodiscard]] WalkWish seen() const;
    /// What another walk begins with that goes on from here.
    [[nodiscard]] WalkStart present() const {
        return {scene_state_, edits_, wish_.time, wish_.edits};
    }
    /// The newest picture; null where it is not of what is seen.
    [[nodiscard]] const LivePicture* picture() const { return drawn_ ? &live_.picture() : nullptr; }

    /// Show another state of the scene from the next frame on: views, camera and questions stay,
    /// nothing is read. False: it cannot be, and all is as it was; change_problem() says why.
    [[nodiscard]] bool change_scene(SceneState state);
    /// Why the last change was not made; "": it was.
    [[nodiscard]] const std::string& change_problem() const { return change_problem_; }
    [[nodiscard]] const SceneState& scene_state() const { return scene_state_; }

    /// Show the scene as its files have it by now: views, camera, questions, dimmers, the time and
    /// edits stay, as far as what they speak of is still there. Where it cannot be shown all is as
    /// it was, and the reply says why.
    /// @param news  with a scene
    [[nodiscard]] FollowedReply follow(const SceneNews& news);

    /// Where and when the scene's sky is seen; nothing where no generator has written it.
    [[nodiscard]] std::optional<TimePlace> time_place() const;

    /// Height of the eye above the ground [m].
    [[nodiscard]] double eye_height() const { return eye_height_; }

  private:
    using Clock = std::chrono::steady_clock;
    /// What the page's numbers are made of.
    struct Pace {
        Clock::time_point since;
        std::uint32_t frames = 0;
        std::uint64_t rays = 0;
        double reused = 0, inferred = 0, guessed = 0, pixels = 0;
    };

    struct Size {
        int width, height;
    };

    void answer(const InboxContents& inbox);
    void take_session(const SceneSession& session);
    [[nodiscard]] SceneState state_in(const SceneStates& states, const Model& model,
                                      const CheckedEdits& edits) const;
    void edit();
    void mix_lights();
    void dim();
    void set_time();
    void tell_time();
    [[nodiscard]] bool is_dimming() const;
    void reply(const WalkQuestion& question);
    [[nodiscard]] MaterialReply describe(const MaterialRequest& request) const;
    void save_files(const InboxContents& inbox) const;
    void measure_probes();
    void draw_plan();
    void measure_planes(const StopFlag& stop);
    void draw(const StopFlag& stop);
    [[nodiscard]] bool may_be_kept() const;
    void recall(WalkAmbient ambient, const StopFlag& stop);
    void keep(Clock::time_point now);
    void note_size(Size size, double budget);
    void clean();
    void show(Clock::time_point now);
    void note_pace(Clock::time_point begin);
    void report(Clock::time_point now);
    [[nodiscard]] View on_the_ground(const ViewRequest& request) const;
    [[nodiscard]] bool has_work() const;
    /// Of the next picture: smaller than wished while the view moves, if there is no time for all
    /// of it, and where the eye comes to a place of which hardly anything is known.
    [[nodiscard]] Size size_now() const;
    /// Time for the steps of the next picture [s].
    [[nodiscard]] double budget() const;
    /// Between two pictures of a view that rests.
    [[nodiscard]] Clock::duration progressive_interval(Clock::time_point now) const;

    RenderLoopOptions options_;
    LiveFrames& frames_;
    WarningSink& warnings_;
    const SceneSession* session_;
    std::shared_ptr<const CompiledScene> read_;  ///< the scene as it was read
    std::reference_wrapper<const Model> model_;  ///< the same
    std::unique_ptr<SceneStates> states_;        ///< always there
    SceneState scene_state_;                     ///< what session_ shows of it
    std::string change_problem_;
    ClientInbox& client_inbox_;
    WalkScreen& screen_;
    int threads_;
    bool has_indirect_;
    std::shared_ptr<const LightGroups> groups_;  ///< that may be dimmed; null: none
    LiveWalk live_;
    std::optional<WalkAnswers> answers_;  ///< always there
    WalkGlare glare_;
    WalkIsolux isolux_;
    std::optional<PlanSurvey> survey_;  ///< always there
    ExecutorTaskRunner task_runner_;
    std::map<ClientId, std::uint32_t> plan_questions_;  ///< the newest of each
    double eye_height_;

    CheckedEdits edits_;   ///< that are shown
    bool edited_ = false;  ///< since a picture was drawn, and little of it is another one
    WalkWish wish_;
    std::optional<View> view_;               ///< that is drawn
    std::optional<ViewReply> told_;          ///< what watchers know
    bool drawn_ = false;                     ///< the picture is of view_, as wished
    bool shown_ = false;                     ///< as it is, with the display that is wished
    int small_sketches_ = 0, sketches_ = 0;  ///< of a new place, at most: small ones, whole ones
    bool relit_ = false;  ///< the small ones are of other light in the same place
    Clock::time_point moved_, shown_at_, measured_at_, dimmed_at_;
    bool dimmed_ = false;  ///< since a picture was shown
    MovingSize moving_size_;
    std::optional<CleanView> clean_view_;  ///< nothing: none is shown
    bool recalled_ = false;                ///< what others have kept was looked for
    std::optional<View> kept_view_;        ///< of the picture that is kept
    bool kept_whole_ = false;              ///< nothing of it was missing
    Clock::time_point kept_at_;
    double share_ = 1;          ///< see share_time
    double aside_seconds_ = 0;  ///< beside the steps of a moving view's frame, of late
    Pace pace_;
};

}  // namespace lightwalk
