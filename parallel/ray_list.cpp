#include "parallel/ray_list.h"

#include <algorithm>

namespace lightwalk {

void trace_ray_list(const Tracer& tracer, WorkerContexts& contexts,
                    std::span<const RayQuery> queries, std::uint64_t first_index,
                    const RayListOptions& options, Executor& executor, std::size_t rays_per_task,
                    TakeListedRay take) {
    const std::size_t tasks = (queries.size() + rays_per_task - 1) / rays_per_task;
    executor.for_each(tasks, [&](std::size_t task, int worker) {
        const std::size_t begin = task * rays_per_task;
        const std::size_t count = std::min(rays_per_task, queries.size() - begin);
        trace_rays(tracer, contexts[worker], queries.subspan(begin, count), first_index + begin,
                   options, [&](std::size_t i, const Ray& ray, const Hit& first) {
                       take(begin + i, worker, ray, first);
                   });
    });
}

}  // namespace lightwalk
