#include "parallel/ray_list.h"

#include <algorithm>

namespace lightwalk {

void trace_ray_list(const Tracer& tracer, WorkerContexts& contexts,
                    std::span<const RayQuery> queries, std::uint64_t first_index,
                    const RayListOptions& options, Executor& executor, TakeRay take) {
    const std::size_t tasks = (queries.size() + kRaysPerTask - 1) / kRaysPerTask;
    executor.for_each(tasks, [&](std::size_t task, int worker) {
        const std::size_t begin = task * kRaysPerTask;
        const std::size_t count = std::min(kRaysPerTask, queries.size() - begin);
        trace_rays(
            tracer, contexts[worker], queries.subspan(begin, count), first_index + begin, options,
            [&](std::size_t i, const Ray& ray, const Hit& first) { take(begin + i, ray, first); });
    });
}

}  // namespace lightwalk
