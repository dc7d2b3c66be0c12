#pragma once
// Illuminances on planes that somebody asks about: measured beside the frames, coarse to fine.
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "apps/walk/client_inbox.h"
#include "core/plan/measuring_grid.h"
#include "core/trace/tracer.h"
#include "parallel/executor_task_runner.h"
#include "parallel/walk/grid_illuminance.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

class WalkIsolux {
  public:
    /// All must outlive this.
    /// @param groups  of emitters that may be dimmed; null: none
    WalkIsolux(const Tracer& tracer, Executor& executor, WarningSink& warnings,
               const std::shared_ptr<const LightGroups>& groups = nullptr)
        : tracer_(&tracer),
          executor_(executor),
          task_runner_(executor),
          sight_(std::in_place, tracer.scene(), tracer.options().back_faces_visible),
          contexts_(tracer, warnings, executor.concurrency()),
          warnings_(warnings),
          groups_(groups) {
        if (groups) contexts_.sum_by(groups);
    }

    /// In place of what this client has asked before.
    /// @param unit  the eye's height above the floor [m]
    void ask(ClientId client, const IsoluxRequest& request, double unit);
    /// Nobody waits for an answer to this client any more.
    void forget(ClientId client) { questions_.erase(client); }

    /// The scene is another one, of the same surfaces: what is not finished is begun anew. What the
    /// constructor was given is not used any more.
    void change(const Tracer& tracer, WarningSink& warnings,
                const std::shared_ptr<const LightGroups>& groups);
    /// Of the light groups in what follows: what is not finished is begun anew.
    void mix(const LightMixture& mixture);

    [[nodiscard]] bool is_asked() const { return !questions_.empty(); }
    /// Measure for so long, for one client after the other, and tell what is new [s].
    void step(double seconds, const StopFlag& stop, ClientInbox& client_inbox);

  private:
    using Clock = std::chrono::steady_clock;
    struct Question {
        std::uint32_t id;
        MeasuringSurvey survey;
        std::optional<GridIlluminance> light = std::nullopt;  ///< once the points are found
        int stride = 0;                                       ///< that was told last
        Clock::time_point told = {};
    };
    /// False: it is answered.
    [[nodiscard]] bool go_on(Question& question, ClientId client, double seconds,
                             const StopFlag& stop, ClientInbox& client_inbox);

    void begin_anew();
    [[nodiscard]] std::optional<IsoluxFigures> figures_of(const GridIlluminance& light) const;

    const Tracer* tracer_;
    Executor& executor_;
    ExecutorTaskRunner task_runner_;
    std::optional<PlanSight> sight_;  ///< always there; surveys refer to it
    WorkerContexts contexts_;
    WarningSink& warnings_;
    std::shared_ptr<const LightGroups> groups_;  ///< null: none
    LightMixture mixture_;
    std::map<ClientId, Question> questions_;
    ClientId turn_{};  ///< of the client that was answered last
};

}  // namespace lightwalk
