#pragma once
// Tracing of lists of single rays, as rtrace does, by all workers of an executor.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/trace/trace_rays.h"
#include "parallel/executor.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Number of consecutive rays that one task traces, in order, where rays are short.
inline constexpr std::size_t kRaysPerTask = 64;

/// Takes a finished ray and its nearest hit before shading, on the thread of this worker.
using TakeListedRay =
    FunctionRef<void(std::size_t index, int worker, const Ray& ray, const Hit& first)>;

/// Trace `queries` with all workers of an executor. Ray i has the random numbers of ray
/// `first_index` + i of the whole input, for any number of workers.
/// @param rays_per_task  consecutive rays that one task traces, in order; at least 1
void trace_ray_list(const Tracer& tracer, WorkerContexts& contexts,
                    std::span<const RayQuery> queries, std::uint64_t first_index,
                    const RayListOptions& options, Executor& executor, std::size_t rays_per_task,
                    TakeListedRay take);

}  // namespace lightwalk
