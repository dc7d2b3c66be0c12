#pragma once
// Walks drawn by simulated ranks: the real frames of rank 0, owners of parts, and their messages;
// the program that uses them, and what is walked through, stand for those of `walk`.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/session/rank_frames.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/walk/cloud_frames.h"
#include "tests/simulation/rank_run.h"
#include "tests/simulation/walk_room.h"
#include "tests/test_scene.h"

namespace lightwalk::simulation {

/// What is wanted next.
struct WalkStep {
    View view;
    int width = 20, height = 14;
    LightMixture mixture;     ///< where groups are kept
    WalkRoom room;            ///< another one than before: the scene changes
    bool keeps_some = false;  ///< then only the points of the screen are outdated
    bool refused = false;     ///< before that a change is wanted that one rank cannot prepare
    bool looks_aside = false;
    bool settles = false;  ///< it rests until all is traced
};

struct WalkPlan : RankPlan {
    int projectors = 32;      ///< see RankSettings
    bool apart = false;       ///< see FrameOrder
    bool groups = false;      ///< light groups are kept
    CloudOptions cloud = {};  ///< its budget is in virtual time
};
[[nodiscard]] std::string description_of(const WalkPlan& plan);

/// A walk, and how far it has come: the next run goes on from there.
struct WalkProgress {
    std::vector<WalkStep> steps;
    std::size_t at = 0;
};

/// What runs need once: a scene that rank 0's frames look for small light sources.
struct WalkStage {
    test::TestScene scene{
        "void light lamp 0 0 3 1 1 1\n"
        "lamp polygon panel 0 0 9  -1 -1 9  -1 1 9  1 1 9\n"};
    std::shared_ptr<const LightGroups> groups = std::make_shared<const LightGroups>(
        LightGroups{{"one", "other"}, std::vector<std::uint8_t>(8), 0});
};

class WalkRun final : public RankRun {
  public:
    WalkRun(Fibers& fibers, const WalkPlan& plan, const Planted& planted, WalkStage& stage,
            WalkProgress& progress, std::uint64_t seed);
    [[nodiscard]] std::size_t first_step() const { return first_step_; }

  private:
    /// The scene of one rank.
    struct Scene {
        WalkRoom room;
        std::optional<WalkRoom> prepared;
    };

    void change(RankSettings& settings) const override { settings.projectors = plan_.projectors; }
    void lead(RankLink& link) override;
    void trace(RankLink& link) override;
    void take(ProgramNews news) override;
    [[nodiscard]] bool all_drawn() const override { return progress_.at == progress_.steps.size(); }

    // On rank 0. False: interrupted.
    void begin(RankLink& link, const WalkStep& first);
    [[nodiscard]] bool take_step(RankLink& link, const WalkStep& step);
    [[nodiscard]] std::optional<AssembledFrame> draw(RankLink& link, FrameOrder order);
    [[nodiscard]] bool change_room(RankLink& link, const WalkStep& step, bool refused);
    void take_room(const WalkStep& step);
    [[nodiscard]] bool look_aside(const WalkStep& step);
    [[nodiscard]] bool show(const WalkStep& step);
    [[nodiscard]] bool settle(const WalkStep& step);
    void check(const WalkStep& step, const WalkFrame& shown);
    void check_with_one(const WalkStep& step, const WalkFrame& shown);
    void check_settled(const WalkStep& step, const Frame& shown);

    // On ranks that trace.
    [[nodiscard]] WalkScene scene_of(int rank);
    [[nodiscard]] std::unique_ptr<FrameCaster> make_rays(int rank, const FrameOrder& order);
    void note_traced(const FrameOrder& order, std::span<const PixelPlace> places, int sample);

    [[nodiscard]] bool has_budget() const { return plan_.cloud.budget > 0; }
    [[nodiscard]] RoomCaster::Picture picture_of(const WalkStep& step, FrameUse use) const {
        return {step.view, step.width, step.height, use, step.mixture, plan_.groups};
    }

    const WalkPlan& plan_;
    WalkStage& stage_;
    WalkProgress& progress_;
    std::size_t first_step_;
    std::vector<Scene> scenes_;                                ///< by rank
    std::map<FrameNumber, std::vector<std::uint8_t>> traced_;  ///< how often, by sample and pixel

    // On rank 0.
    std::unique_ptr<Executor> serial_;
    std::unique_ptr<RankFrames> frames_;
    std::unique_ptr<CloudFrames> alone_;  ///< the same walk by one process
    Frame shown_;                         ///< the last one
    std::optional<FinishedFrame> finished_;
    FrameNumber ordered_ = 0;                 ///< frame or change
    std::map<int, PreparedChange> prepared_;  ///< by rank
};

}  // namespace lightwalk::simulation
