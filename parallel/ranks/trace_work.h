#pragma once
// The threads of a rank that trace pictures and rays: work in, what came of it out.
#include <functional>
#include <memory>
#include <string>

#include "parallel/block_renderer.h"
#include "parallel/executor.h"
#include "parallel/ranks/rank_link.h"

namespace lightwalk {

/// What tracing is, for each payload. One that is empty must not be asked for.
struct TraceFunctions {
    /// Makes what renders a job's blocks, and keeps alive what it needs. Called once a job on every
    /// rank that traces, by one of the tracing threads, even where the rank gets none of the
    /// blocks.
    std::function<std::shared_ptr<const BlockRenderer>(const PictureJob& job)> make_renderer;
    /// What the rays of a chunk say. Called by many threads, each with its own `worker`.
    std::function<std::string(const RayChunk& chunk, int worker)> answer_chunk;
};

/// All workers of `executor` trace what comes, until the inbox is closed or `stop` is requested.
/// The first exception ends the others' work after their piece and is thrown again here.
void trace_work(RankLink& link, const TraceFunctions& functions, Executor& executor,
                const StopFlag& stop);

/// Runs `task(worker)` on each worker of the executor; where one throws, the inbox is closed, so
/// that the others end.
template <class Task>
void run_on_all(TracerInbox& inbox, Executor& executor, const StopFlag& stop, Task task) {
    const auto guarded = [&](std::size_t, int worker) {
        try {
            task(worker);
        } catch (...) {
            inbox.close();
            throw;
        }
    };
    executor.for_each(static_cast<std::size_t>(executor.concurrency()), guarded, stop);
}

}  // namespace lightwalk
