#pragma once
// A renderer's work by ranks that share it.
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/session/rank_frames.h"
#include "apps/session/render_backend.h"
#include "parallel/coefficient_rounds.h"
#include "parallel/ranks/assembly.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/ranks/rank_link.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {

class RankBackend final : public RenderBackend {
  public:
    /// Throws InputError.
    /// @param link   must outlive this
    /// @param scene  after compile()
    RankBackend(RankLink& link, std::shared_ptr<const CompiledScene> scene,
                RendererOptions options);
    /// All ranks' caches begin with the values of rank 0's ambient file, and share what is new. By
    /// all ranks, when each has its backend.
    void share_values();

    void run(FunctionRef<void()> lead) override;
    [[nodiscard]] bool leads() const override { return link_.leads(); }
    void begin(const PictureRequest& request) override;
    void begin(const RayTask& list) override;
    [[nodiscard]] std::optional<Frame> finish(const PictureRequest& request) override;
    [[nodiscard]] std::optional<std::string> finish(const RayTask& list) override;
    /// The next picture's blocks are there when the last ones of this one are still out. But before
    /// a deterministic one all rays of the one before must have ended.
    [[nodiscard]] std::size_t pictures_ahead() const override {
        return options_.reuse || options_.goal.given() || prepass() == CachePrepass::deterministic
                   ? 1
                   : 2;
    }
    [[nodiscard]] RayDemand ray_demand(bool wait, bool begun) override;
    [[nodiscard]] LiveFrames& frames() override;
    void change_model(const ModelChange& change) override;
    [[nodiscard]] RunStatistics statistics() const override;

  private:
    /// A picture that rank 0 has ordered.
    struct Job {
        JobId number = 0;
        std::shared_ptr<CheckpointSink> checkpoint;  ///< null: none
        double done = 0;                             ///< share of its pixels
        std::optional<FinishedPicture> picture;
    };

    // On rank 0.
    void order(const PictureRequest& request);
    /// What was ordered first; nothing: stopped.
    [[nodiscard]] std::optional<Frame> receive(const PictureRequest& request,
                                               TakeProgress progress);
    void receive_news(bool wait);
    [[nodiscard]] std::optional<AssembledFrame> draw(FrameOrder order, const StopFlag& stop);
    /// Until all that trace have prepared a change, or could not.
    void wait_for_prepared();
    /// Throws InputError where one could not.
    void check_prepared() const;
    [[nodiscard]] double kept_points() const;  ///< share that the change will keep

    // On every rank (rank_tracing.cpp).
    /// What rank 0 orders is traced, until no more comes.
    void trace();
    /// What draws a walk's frames.
    void light_frames();
    /// Another scene is the one at hand from now on. Values of the one before are shared no more.
    void take(ChangedScene next, FrameNumber number);
    [[nodiscard]] WalkScene walk_scene();
    [[nodiscard]] std::shared_ptr<const BlockRenderer> make_renderer(const PictureJob& job);
    [[nodiscard]] std::string answer_chunk(const RayChunk& chunk, int worker);
    /// Where coefficients are kept all ranks answer one list after the other together.
    void answer_lists();
    /// The rank's share of a list, once the records that it looks for are there; nothing: stopped.
    [[nodiscard]] std::optional<std::string> answer_share(const RayTask& list);
    [[nodiscard]] std::optional<std::string> answer_together(const RayTask& list);
    [[nodiscard]] std::unique_ptr<SceneCaster> make_rays(const FrameOrder& order);
    void fill_cache(const Camera& camera, const FrameOptions& options, CachePrepass how,
                    Executor& executor);
    /// Rank 0 hears what comes of the rounds of a deterministic picture, also where it does not
    /// trace: it may keep a file of their values, or a checkpoint.
    void listen_to_rounds(const Camera& camera, const FrameOptions& options);
    [[nodiscard]] RankReport report() const;

    RankLink& link_;
    TraceCounters past_counters_;  ///< of prepasses, and of scenes before this one
    std::optional<WalkLight> light_, direct_light_;  ///< of a walk's frames
    LightMixture mixture_;                           ///< of the frame that is drawn
    std::unique_ptr<CoefficientRounds> rounds_;      ///< null: coefficients are not kept
    std::optional<ChangedScene> prepared_;           ///< see ChangeOrder; not on rank 0

    // On rank 0.
    std::deque<Job> jobs_;  ///< oldest first
    /// That keeps the rounds of the picture that was ordered last; null: none does.
    std::shared_ptr<CheckpointSink> kept_rounds_;
    RayDemand demand_;  ///< lists that are wanted and not begun
    std::uint64_t next_chunk_ = 0;
    std::deque<std::string> answers_;  ///< of lists of rays, in their order
    std::optional<FinishedFrame> frame_;
    std::unique_ptr<Executor> own_executor_;           ///< of what rank 0 draws by itself
    std::unique_ptr<RankFrames> frames_;               ///< null: not asked for yet
    FrameNumber change_ = 0;                           ///< that is prepared
    std::map<int, PreparedChange> answers_to_change_;  ///< by rank
};

}  // namespace lightwalk
