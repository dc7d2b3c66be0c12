#pragma once
// The threads of a rank that trace: blocks in, pixels out.
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "parallel/block_renderer.h"
#include "parallel/executor.h"
#include "parallel/ranks/message.h"
#include "parallel/ranks/timeline.h"

namespace lightwalk {

/// Makes what renders a job's blocks, and keeps alive what it needs. Called once a job on every
/// rank that traces, by one of the tracing threads, even where the rank gets none of the blocks.
using MakeRenderer = std::function<std::shared_ptr<const BlockRenderer>(const JobStart&)>;
/// Takes a message for the rank's worker; called by many threads.
using TellWorker = std::function<void(Message)>;

class RankTracer {
  public:
    /// @param timeline  with a row for each worker of the executor; null: none
    RankTracer(MakeRenderer make, TellWorker tell, Timeline* timeline = nullptr)
        : make_(std::move(make)), tell_(std::move(tell)), timeline_(timeline) {}

    /// JobStart, GiveBlocks, Finish: from any thread.
    void take(Message message);

    /// All workers of `executor` trace what is given, until the end is or `stop` is requested. The
    /// first exception ends the others' work after their block and is thrown again here.
    void run(Executor& executor, const StopFlag& stop);

  private:
    struct Job {
        JobStart start;
        bool begun = false;  ///< somebody makes its renderer, or has
        std::once_flag made;
        std::shared_ptr<const BlockRenderer> renderer;
    };
    struct Work {
        std::optional<JobBlock> block;  ///< nothing: the job is new
        std::shared_ptr<Job> job;
    };
    [[nodiscard]] std::shared_ptr<Job> new_job();
    [[nodiscard]] std::optional<Work> next(int worker, const StopFlag& stop);
    void serve(int worker, const StopFlag& stop);

    MakeRenderer make_;
    TellWorker tell_;
    Timeline* timeline_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::map<JobId, std::shared_ptr<Job>> jobs_;
    std::deque<JobBlock> blocks_;
    bool finished_ = false;
};

}  // namespace lightwalk
