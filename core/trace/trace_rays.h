#pragma once
// Tracing of separate rays, one after the other.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/function_ref.h"
#include "core/trace/ray_query.h"
#include "core/trace/tracer.h"

namespace lightwalk {

/// Takes a finished ray and its nearest hit before shading.
using TakeRay = FunctionRef<void(std::size_t index, const Ray& ray, const Hit& first)>;

/// Trace `queries` in order; ray i has the random numbers of ray `first_index` + i of the whole
/// input.
void trace_rays(const Tracer& tracer, TraceContext& context, std::span<const RayQuery> queries,
                std::uint64_t first_index, const RayListOptions& options, TakeRay take);

}  // namespace lightwalk
