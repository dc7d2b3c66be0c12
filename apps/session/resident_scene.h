#pragma once
// A compiled scene that stands ready for requests that name it, in a process that forks for each.
#include <memory>
#include <string>
#include <vector>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/ranks.h"
#include "apps/session/scene_premises.h"

namespace lightwalk {

class Executor;

class ResidentScene {
  public:
    /// Reads and compiles, with the thread that calls this alone: none is left running. Throws
    /// InputError, also for a scene that cannot stay: one that is frozen, or partly comes from
    /// commands.
    explicit ResidentScene(SceneSource source);

    /// Whether its files are unchanged.
    [[nodiscard]] bool files_hold() const { return premises_->files_hold(); }
    /// The scene, if a request would read the same; null: it would not, or might not. Once in a
    /// process, which warns by the request of what there was to warn of, and goes on to do so.
    [[nodiscard]] std::shared_ptr<const CompiledScene> answer(const RendererRequest& request) const;

  private:
    struct Use {
        std::vector<std::string> warnings;  ///< before any request
        TakeWarning take;                   ///< of the request; none: it is before it
        std::unique_ptr<Executor> alone;    ///< oneTBB has one thread; null: as many as it wants
    };
    SceneSource source_;
    std::shared_ptr<ScenePremises> premises_;
    std::shared_ptr<Use> used_;
    std::shared_ptr<const CompiledScene> scene_;
};

}  // namespace lightwalk
