#pragma once
// Whether what somebody sees glares: a picture of all that lies before the eye, drawn bit by bit,
// and what it says.
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/walk/client_inbox.h"
#include "core/cloud/progressive_light.h"
#include "core/trace/tracer.h"
#include "parallel/executor.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

class WalkGlare {
  public:
    /// All must outlive this.
    /// @param groups  of emitters that may be dimmed; null: none
    WalkGlare(const Tracer& tracer, Executor& executor, WarningSink& warnings,
              const std::shared_ptr<const LightGroups>& groups = nullptr)
        : tracer_(&tracer),
          executor_(executor),
          contexts_(tracer, warnings, executor.concurrency()),
          warnings_(warnings),
          groups_(groups) {
        if (groups) contexts_.sum_by(groups);
    }
    /// The scene is another one, of the same surfaces: what is asked is answered by it. What the
    /// constructor was given is not used any more.
    void change(const Tracer& tracer, WarningSink& warnings,
                const std::shared_ptr<const LightGroups>& groups);
    /// Of the light groups in what follows, and in what is drawn already.
    void mix(const LightMixture& mixture);

    /// Somebody asks about a view. What others ask about the same one is answered with it.
    void ask(ClientId client, const GlareRequest& request, const View& view);
    /// The view is another one: nobody gets an answer any more.
    void forget(ClientInbox& client_inbox);

    [[nodiscard]] bool is_asked() const { return !asked_.empty(); }
    /// Draw for so long, and tell how far it is; at the end the answer [s].
    void step(double budget, const StopFlag& stop, ClientInbox& client_inbox);

  private:
    struct Asked {
        ClientId client;
        std::uint32_t id = 0;
    };
    [[nodiscard]] GlareReply evaluate() const;
    /// Of a picture's, which begins at the top.
    [[nodiscard]] MeanInterval probability(std::span<const Rgb> radiance, double dgp) const;
    void tell(GlareReply reply, ClientInbox& client_inbox) const;

    void begin();

    const Tracer* tracer_;
    Executor& executor_;
    WorkerContexts contexts_;
    WarningSink& warnings_;
    std::shared_ptr<const LightGroups> groups_;  ///< null: none
    LightMixture mixture_;
    std::vector<Asked> asked_;
    View view_;
    std::optional<ProgressiveLight> picture_;
    double told_ = 0;  ///< share that was told last
};

}  // namespace lightwalk
