#include "parallel/ranks/rank_tracer.h"

#include <chrono>
#include <utility>

#include "parallel/ranks/roles.h"

namespace lightwalk {

void RankTracer::take(Message message) {
    {
        const std::lock_guard lock(mutex_);
        if (auto* start = std::get_if<JobStart>(&message)) {
            const JobId id = start->job;
            std::erase_if(jobs_,
                          [&](const auto& entry) { return entry.first + kJobsAtOnce <= id; });
            auto job = std::make_shared<Job>();
            job->start = std::move(*start);
            jobs_[id] = std::move(job);
        } else if (const auto* given = std::get_if<GiveBlocks>(&message)) {
            blocks_.insert(blocks_.end(), given->blocks.begin(), given->blocks.end());
        } else {
            finished_ = true;
        }
    }
    changed_.notify_all();
}

/// A job that nobody has begun, to be begun by the caller, which holds the mutex; null: none.
std::shared_ptr<RankTracer::Job> RankTracer::new_job() {
    for (auto& [id, job] : jobs_) {
        if (!std::exchange(job->begun, true)) return job;
    }
    return nullptr;
}

std::optional<RankTracer::Work> RankTracer::next(int worker, const StopFlag& stop) {
    const TimedActivity waiting(timeline_, worker, Activity::wait);
    // A signal's handler cannot notify: look for its request now and then.
    constexpr std::chrono::milliseconds kPatience{20};
    std::unique_lock lock(mutex_);
    while (!stop.requested()) {
        if (std::shared_ptr<Job> job = new_job()) return Work{std::nullopt, std::move(job)};
        if (!blocks_.empty() || finished_) break;
        changed_.wait_for(lock, kPatience);
    }
    if (blocks_.empty() || stop.requested()) return std::nullopt;
    const JobBlock block = blocks_.front();
    blocks_.pop_front();
    return Work{block, jobs_.at(block.job)};
}

void RankTracer::serve(int worker, const StopFlag& stop) {
    using Clock = std::chrono::steady_clock;
    BlockPixels pixels;
    while (std::optional<Work> work = next(worker, stop)) {
        Job& job = *work->job;
        const Clock::time_point begin = Clock::now();
        std::call_once(job.made, [&] { job.renderer = make_(job.start); });
        if (!work->block) continue;
        if (!job.renderer->render(work->block->block, worker, pixels)) return;
        const Clock::time_point end = Clock::now();
        if (timeline_ != nullptr) timeline_->add(worker, Activity::trace, begin, end);
        const std::chrono::duration<double> seconds = end - begin;
        BlockDone done{{*work->block, {}}, seconds.count()};
        if (job.start.keep) done.pixels.values = pixels.values;
        tell_(std::move(done));
    }
}

void RankTracer::run(Executor& executor, const StopFlag& stop) {
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
