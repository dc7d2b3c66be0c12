#pragma once
// The threads of a rank that trace rays from a stream: chunks in, answers out.
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>

#include "parallel/executor.h"
#include "parallel/ranks/message.h"
#include "parallel/ranks/timeline.h"

namespace lightwalk {

/// What the rays of a chunk say. Called by many threads, each with its own `worker`.
using AnswerChunk = std::function<std::string(const RayChunk& chunk, int worker)>;

class ChunkTracer {
  public:
    /// @param tell      takes ChunkAnswer for the rank's worker; called by many threads
    /// @param timeline  gets what the threads do; null: nobody wants to know
    ChunkTracer(AnswerChunk answer, std::function<void(Message)> tell, Timeline* timeline = nullptr)
        : answer_(std::move(answer)), tell_(std::move(tell)), timeline_(timeline) {}

    /// RayChunk, Finish: from any thread.
    void take(Message message);

    /// All workers of `executor` answer what is given, until the end is or `stop` is requested. The
    /// first exception ends the others' work after their chunk and is thrown again here.
    void run(Executor& executor, const StopFlag& stop);

  private:
    [[nodiscard]] std::optional<RayChunk> next(int worker, const StopFlag& stop);
    void serve(int worker, const StopFlag& stop);

    AnswerChunk answer_;
    std::function<void(Message)> tell_;
    Timeline* timeline_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::deque<RayChunk> chunks_;
    bool finished_ = false;
};

}  // namespace lightwalk
