#pragma once
// Before a picture with indirect light: fill the ambient cache, evenly over the view.
#include "core/transport/tracer.h"
#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/frame.h"
#include "parallel/freezable_cache.h"
#include "parallel/round_exchange.h"

namespace lightwalk {

enum class CachePrepass {
    none,   ///< the picture fills the cache as it goes
    quick,  ///< one coarse picture, by all workers
    /// Finer and finer pictures, the last one whole: what they miss is computed in rounds, whose
    /// values are the same for any number of workers. Then the cache takes no more, so that what is
    /// looked up no longer depends on who computes what when.
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

/// Trace coarse pictures of the view that leave nothing but ambient values, so that the picture
/// itself finds most of them. Their pixels are not kept: computed while the cache was nearly empty,
/// they would stand out in a grid.
/// @param options   of the picture that is to come. `deterministic` looks at all of it even when
///                  only a window is wanted, so that every window finds the same values
/// @param cache     the one that `tracer` uses; open while the prepass lasts, and after it unless
///                  `deterministic`
/// @param progress  of the prepass as a whole; otherwise as in render_frame, as are the others
/// @param exchange  with other processes that call this with the same scene and options for a
///                  `deterministic` prepass, and end with the same cache; null: there are none.
///                  Counters tell of this process alone
[[nodiscard]] CachePrepassResult fill_ambient_cache(const Tracer& tracer, const Camera& camera,
                                                    const FrameOptions& options,
                                                    CachePrepass prepass, FreezableCache& cache,
                                                    Executor& executor, WorkerContexts& contexts,
                                                    const StopFlag& stop, TakeProgress progress,
                                                    RoundExchange* exchange = nullptr);

}  // namespace lightwalk
