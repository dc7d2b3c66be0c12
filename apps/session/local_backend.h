#pragma once
// A renderer's work by the threads of this process.
#include "apps/session/render_backend.h"
#include "parallel/coefficient_rounds.h"

namespace lightwalk {

class LocalBackend final : public RenderBackend {
  public:
    /// Throws InputError.
    /// @param scene  after compile()
    LocalBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options);

    [[nodiscard]] std::optional<Frame> finish(const PictureRequest& request) override;
    [[nodiscard]] std::optional<std::string> finish(const RayTask& list) override;
    /// The work is done by finish(): there is nothing to wait for.
    [[nodiscard]] RayDemand ray_demand(bool wait, bool begun) override;
    [[nodiscard]] LiveFrames& frames() override;
    void change(const std::shared_ptr<const CompiledScene>& scene) override;

  private:
    [[nodiscard]] bool prepare(const PictureRequest& request, bool first) override;
    [[nodiscard]] CachePrepassResult fill_cache(const PictureRequest& request,
                                                TakeProgress progress);

    [[nodiscard]] std::optional<Frame> draw_pass(const PictureRequest& pass, TakeProgress progress);
    void fill_coefficients(const RayTask& list);

    GroupOfOne alone_;
    std::unique_ptr<CoefficientRounds> rounds_;  ///< null: coefficients are not kept
    std::unique_ptr<LiveFrames> frames_;         ///< null: not asked for yet
};

}  // namespace lightwalk
