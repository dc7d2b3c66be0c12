#include "parallel/ranks/chunk_tracer.h"

#include <chrono>
#include <utility>

namespace lightwalk {

void ChunkTracer::take(Message message) {
    {
        const std::lock_guard lock(mutex_);
        if (auto* chunk = std::get_if<RayChunk>(&message))
            chunks_.push_back(std::move(*chunk));
        else
            finished_ = true;
    }
    changed_.notify_all();
}

std::optional<RayChunk> ChunkTracer::next(int worker, const StopFlag& stop) {
    const TimedActivity waiting(timeline_, worker, Activity::wait);
    // A signal's handler cannot notify: look for its request now and then.
    constexpr std::chrono::milliseconds kPatience{20};
    std::unique_lock lock(mutex_);
    while (chunks_.empty() && !finished_ && !stop.requested()) changed_.wait_for(lock, kPatience);
    if (chunks_.empty() || stop.requested()) return std::nullopt;
    RayChunk chunk = std::move(chunks_.front());
    chunks_.pop_front();
    return chunk;
}

void ChunkTracer::serve(int worker, const StopFlag& stop) {
    using Clock = std::chrono::steady_clock;
    while (const std::optional<RayChunk> chunk = next(worker, stop)) {
        const Clock::time_point begin = Clock::now();
        std::string bytes = answer_(*chunk, worker);
        const Clock::time_point end = Clock::now();
        if (timeline_ != nullptr) timeline_->add(worker, Activity::trace, begin, end);
        const std::chrono::duration<double> seconds = end - begin;
        tell_(ChunkAnswer{chunk->number, static_cast<std::uint32_t>(chunk->rays()), seconds.count(),
                          std::move(bytes)});
    }
}

void ChunkTracer::run(Executor& executor, const StopFlag& stop) {
    const auto task = [&](std::size_t, int worker) {
        try {
            serve(worker, stop);
        } catch (...) {
            take(Finish{});  // for the other threads
            throw;
        }
    };
    executor.for_each(static_cast<std::size_t>(executor.concurrency()), task, stop);
}

}  // namespace lightwalk
