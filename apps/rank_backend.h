#pragma once
// A renderer's work by ranks that share it, and how all commands come to a renderer.
#include <memory>
#include <optional>
#include <string>

#include "apps/rank_link.h"
#include "apps/rank_work.h"
#include "apps/renderer_request.h"
#include "apps/session/render_backend.h"
#include "parallel/executor.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Reads and compiles the scene. By all ranks, all of which go on, or none: throws AgreedProblem;
/// where there is one process InputError.
/// @param link      the other ranks; null: this process is alone
/// @param warnings  must outlive the renderer
[[nodiscard]] Renderer open_renderer(RankLink* link, const RendererRequest& request,
                                     WarningSink& warnings);

class RankBackend final : public RenderBackend {
  public:
    /// `link` and what the request points to must outlive this.
    RankBackend(RankLink& link, std::unique_ptr<SceneSession> session,
                const RendererRequest& request);
    ~RankBackend() override;

    void run(FunctionRef<void()> lead) override;
    [[nodiscard]] bool leads() const override { return link_.leads(); }
    [[nodiscard]] const SceneSession& session() const override { return *session_; }
    [[nodiscard]] PictureMaker& pictures() override;
    [[nodiscard]] RayMaker& rays() override;
    [[nodiscard]] LiveFrames& frames() override;
    [[nodiscard]] RunStatistics statistics() const override;

  private:
    class Frames;
    [[nodiscard]] std::unique_ptr<RankWork> make_work();
    /// On ranks that trace, until no more comes.
    void trace();
    void follow();
    void run_steered(FunctionRef<void()> lead);
    [[nodiscard]] std::string report() const;

    RankLink& link_;
    std::unique_ptr<SceneSession> session_;
    int projectors_;
    std::unique_ptr<Executor> executor_;
    WorkerContexts contexts_;
    std::unique_ptr<const Tracer> direct_;  ///< of steered walks; null: there is no indirect light
    std::optional<WalkLight> direct_light_;
    std::unique_ptr<RankWork> work_;  ///< null: lists of rays
    RunStatistics statistics_;
    // On rank 0, one of these, when it is first asked for.
    std::unique_ptr<PictureMaker> pictures_;
    std::unique_ptr<RayMaker> rays_;
    std::unique_ptr<Frames> frames_;
};

}  // namespace lightwalk
