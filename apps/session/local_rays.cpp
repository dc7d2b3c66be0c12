#include "apps/session/local_rays.h"

#include <utility>

#include "parallel/ray_list.h"

namespace lightwalk {
namespace {

constexpr std::size_t kRaysAList = 16384;  ///< that are worth the while of many threads

RayListOptions list_options(const RendererOptions& options) {
    RayListOptions list = options.rays;
    list.seed = options.light.seed;
    return list;
}

}  // namespace

LocalRays::LocalRays(const Tracer& tracer, Executor& executor, WorkerContexts& contexts,
                     const RendererOptions& options, const StopFlag& stop)
    : tracer_(tracer), executor_(executor), contexts_(contexts), options_(options), stop_(stop) {
    if (options.observer != nullptr) contexts[0].observer = options.observer;
}

std::optional<std::string> LocalRays::take() {
    const RayTask list = std::move(lists_.front());
    lists_.pop_front();
    if (stop_.requested()) return std::nullopt;
    records_.assign((list.rays.size() + kRaysPerTask - 1) / kRaysPerTask, {});
    trace_ray_list(tracer_, contexts_, list.rays, list.first, list_options(options_), executor_,
                   [&](std::size_t i, const Ray& ray, const Hit& first) {
                       options_.record(list.rays[i], ray, first, records_[i / kRaysPerTask]);
                   });
    std::string all;
    for (const std::string& record : records_) all += record;
    return all;
}

RayDemand LocalRays::demand(bool /*wait*/) {
    // A ray that is watched may be told at length: one at a time.
    const std::size_t rays = options_.observer != nullptr ? 1 : kRaysAList;
    return {lists_.empty() ? std::size_t{1} : std::size_t{0}, rays, !lists_.empty()};
}

std::string answer_rays(const Tracer& tracer, TraceContext& context, const RayTask& list,
                        const RendererOptions& options) {
    std::string all;
    trace_rays(tracer, context, list.rays, list.first, list_options(options),
               [&](std::size_t i, const Ray& ray, const Hit& first) {
                   options.record(list.rays[i], ray, first, all);
               });
    return all;
}

}  // namespace lightwalk
