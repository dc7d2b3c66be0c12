#pragma once
// A compiled scene with its light: a tracer, and the cache of indirect light that goes with it.
#include <memory>
#include <string>
#include <vector>

#include "apps/session/compiled_scene.h"
#include "core/trace/tracer.h"
#include "core/transport/options.h"
#include "io/ambient/ambient_store.h"
#include "parallel/concurrent_cache.h"
#include "parallel/published_cache.h"

namespace lightwalk {

/// How light is followed, and where its indirect values are kept.
struct LightSettings {
    RenderOptions light;
    std::string ambient_file;  ///< "": nowhere
};

/// Whether light is computed with cached indirect values.
[[nodiscard]] bool caches_ambient_values(const RenderOptions& light);

/// Other processes with whom a cache of indirect light is shared.
class CacheSharing {
  public:
    virtual ~CacheSharing() = default;
    /// Whether this process is the one that has the ambient file.
    [[nodiscard]] virtual bool has_file() const = 0;
    /// From now on the cache's new values go to the others, and it gets theirs.
    /// @param cache  must outlive the sharing
    /// @param known  values that the others do not have
    virtual void exchange(PublishedCache& cache, const std::vector<AmbientRecord>& known) = 0;
};

/// Immutable once made, but for the caches. Sessions with different light may share a scene.
class SceneSession {
  public:
    /// Throws InputError.
    /// @param compiled  after compile()
    /// @param warnings  must outlive this
    /// @param sharing   null: there are no other processes
    SceneSession(std::shared_ptr<const CompiledScene> compiled, const LightSettings& settings,
                 WarningSink& warnings, CacheSharing* sharing = nullptr);

    [[nodiscard]] const CompiledScene& compiled() const { return *compiled_; }
    [[nodiscard]] const Scene& scene() const { return compiled_->scene(); }
    [[nodiscard]] const Tracer& tracer() const { return *tracer_; }
    /// Of the scene, and of the tracer.
    [[nodiscard]] const SceneCost& cost() const { return cost_; }

    /// Warn when nothing lights the scene.
    void warn_of_darkness() const;

  private:
    void make_cache(const LightSettings& settings, CacheSharing* sharing);

    std::shared_ptr<const CompiledScene> compiled_;
    WarningSink& warnings_;

  public:
    // Each may use those above it. With cached indirect values, else null:
    std::unique_ptr<ConcurrentCache> ambient;     ///< all values
    std::unique_ptr<AmbientStore> ambient_store;  ///< with an ambient file
    std::unique_ptr<PublishedCache> freezable;    ///< what the tracer asks
    std::vector<AmbientRecord> known;             ///< values that were in the ambient file

  private:
    std::unique_ptr<const Tracer> tracer_;
    SceneCost cost_;
};

}  // namespace lightwalk
