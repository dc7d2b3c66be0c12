#pragma once
// A compiled scene with its light: a tracer, and the cache of indirect light that goes with it.
#include <memory>
#include <string>
#include <vector>

#include "apps/session/compiled_scene.h"
#include "core/ambient/coefficient_cache.h"
#include "core/trace/tracer.h"
#include "core/transport/options.h"
#include "io/ambient/ambient_store.h"
#include "parallel/concurrent_cache.h"
#include "parallel/published_cache.h"

namespace lightwalk {

/// Whether light is computed with cached indirect values.
[[nodiscard]] bool caches_ambient_values(const RenderOptions& light);

/// Immutable once made, but for the caches. Sessions with different light may share a scene.
class SceneSession {
  public:
    /// Throws InputError.
    /// @param compiled      after compile()
    /// @param ambient_file  where indirect values are kept; "": nowhere
    /// @param others        what becomes of values that other processes add to it
    /// @param begun         of the ambient file, see AmbientStore
    /// @param keeps_coefficients  in place of indirect values
    /// @param warnings      must outlive this
    SceneSession(std::shared_ptr<const CompiledScene> compiled, const RenderOptions& light,
                 const std::string& ambient_file, OthersValues others, bool keeps_coefficients,
                 WarningSink& warnings, const std::string& begun = {});

    [[nodiscard]] const CompiledScene& compiled() const { return *compiled_; }
    [[nodiscard]] const std::shared_ptr<const CompiledScene>& shared_compiled() const {
        return compiled_;
    }
    [[nodiscard]] const Scene& scene() const { return compiled_->scene(); }
    [[nodiscard]] const Tracer& tracer() const { return *tracer_; }
    /// Of the scene, and of the tracer.
    [[nodiscard]] const SceneCost& cost() const { return cost_; }

    /// Warn when nothing lights the scene.
    void warn_of_darkness() const;

  private:
    [[nodiscard]] AmbientLimits limits_of(const RenderOptions& light) const;
    void make_cache(const RenderOptions& light, const std::string& ambient_file,
                    OthersValues others, const std::string& begun);

    std::shared_ptr<const CompiledScene> compiled_;
    WarningSink& warnings_;

  public:
    // Each may use those above it. With cached indirect values, else null:
    std::unique_ptr<ConcurrentCache> ambient;     ///< all values
    std::unique_ptr<AmbientStore> ambient_store;  ///< with an ambient file
    std::unique_ptr<PublishedCache> freezable;    ///< what the tracer asks
    std::vector<AmbientRecord> known;             ///< values that were in the ambient file
    // Without these:
    std::unique_ptr<CoefficientCache> coefficients;  ///< null: none are kept

  private:
    std::unique_ptr<const Tracer> tracer_;
    SceneCost cost_;
};

}  // namespace lightwalk
