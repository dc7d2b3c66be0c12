#pragma once
// A renderer's work by the threads of this process.
#include <memory>

#include "apps/session/render_backend.h"
#include "parallel/executor.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

class LocalBackend final : public RenderBackend {
  public:
    /// Throws InputError.
    /// @param scene  after compile()
    LocalBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options);

    void run(FunctionRef<void()> lead) override { lead(); }
    [[nodiscard]] bool leads() const override { return true; }
    [[nodiscard]] const SceneSession& session() const override { return session_; }
    [[nodiscard]] PictureMaker& pictures() override;
    [[nodiscard]] RayMaker& rays() override;
    [[nodiscard]] LiveFrames& frames() override;
    [[nodiscard]] RunStatistics statistics() const override;

  private:
    SceneSession session_;
    std::unique_ptr<Executor> executor_;
    WorkerContexts contexts_;
    RunStatistics statistics_;
    std::unique_ptr<const Tracer> direct_;  ///< of frames(): without indirect light; null: as usual
    // One of these, when it is first asked for.
    std::unique_ptr<PictureMaker> pictures_;
    std::unique_ptr<RayMaker> rays_;
    std::unique_ptr<LiveFrames> frames_;
};

/// The threads that a renderer's options ask for.
[[nodiscard]] std::unique_ptr<Executor> make_executor(const RendererOptions& options);

}  // namespace lightwalk
