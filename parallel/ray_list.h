#pragma once
// Tracing of lists of single rays, as rtrace does, by all workers of an executor.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/function_ref.h"
#include "core/trace/tracer.h"
#include "parallel/executor.h"
#include "parallel/ray_query.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Number of consecutive rays that one task traces, in order.
inline constexpr std::size_t kRaysPerTask = 64;

/// Takes a finished ray and its nearest hit before shading.
using TakeRay = FunctionRef<void(std::size_t index, const Ray& ray, const Hit& first)>;

/// Trace `queries` with one context, in order; ray i has the random numbers of ray `first_index` +
/// i of the whole input.
void trace_rays(const Tracer& tracer, TraceContext& context, std::span<const RayQuery> queries,
                std::uint64_t first_index, const RayListOptions& options, TakeRay take);

/// Trace `queries` with all workers of an executor. Ray i has the random numbers of ray
/// `first_index` + i of the whole input, for any number of workers.
void trace_ray_list(const Tracer& tracer, WorkerContexts& contexts,
                    std::span<const RayQuery> queries, std::uint64_t first_index,
                    const RayListOptions& options, Executor& executor, TakeRay take);

}  // namespace lightwalk
