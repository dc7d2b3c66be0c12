#pragma once
// The cache prepass of a picture with indirect light (Radiance's overture): fills the ambient cache
// evenly over the view.
#include "core/trace/tracer.h"
#include "core/view/view.h"
#include "parallel/comm/group.h"
#include "parallel/executor.h"
#include "parallel/frame.h"
#include "parallel/published_cache.h"

namespace lightwalk {

enum class CachePrepass {
    none,   ///< the picture fills the cache as it goes
    quick,  ///< one coarse picture, by all workers
    /// Ever finer pictures, finally the full one; the ambient values that they lack are computed in
    /// rounds, deterministically for any number of workers. The cache is then frozen, so that later
    /// lookups are independent of scheduling.
    deterministic,
};

struct CachePrepassResult {
    RayCounters rays;
    AmbientCounters ambient;
    bool complete = false;  ///< false: stopped early
};

/// Number of pixels that the prepass of a picture traces.
[[nodiscard]] std::size_t prepass_pixels(const FrameOptions& options, CachePrepass prepass);

/// The coarse picture that a quick prepass traces, of every `step`-th pixel.
inline constexpr int kQuickStep = 6;
[[nodiscard]] FrameOptions quick_prepass(const FrameOptions& options, int step = kQuickStep);

/// Trace coarse pictures of the view to fill the ambient cache, so that the picture itself finds
/// most values there. Their pixels are discarded: computed while the cache was nearly empty, they
/// would be visible as a grid.
/// @param options   of the picture that follows. `deterministic` covers the whole picture even
/// where only a window is rendered, so that every window finds the same values
/// @param cache     the one that `tracer` uses; open while the prepass lasts, and after it unless
///                  `deterministic`
/// @param progress  of the whole prepass; called as in render_frame. Further parameters as in
/// render_frame
/// @param exchange  with other processes that call this with the same scene and options for a
///                  `deterministic` prepass, and end with the same cache; null: there are none.
///                  Counters tell of this process alone
/// @param checkpoint  keeps the rounds of a `deterministic` prepass; null: none does
[[nodiscard]] CachePrepassResult fill_ambient_cache(
    const Tracer& tracer, const Camera& camera, const FrameOptions& options, CachePrepass prepass,
    PublishedCache& cache, Executor& executor, WorkerContexts& contexts, const StopFlag& stop,
    TakeProgress progress, Group* exchange = nullptr, CheckpointSink* checkpoint = nullptr);

}  // namespace lightwalk
