#pragma once
// This process as one of several ranks: its messages, and what the commands want of them.
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/math/function_ref.h"
#include "parallel/checkpoint_sink.h"
#include "parallel/published_cache.h"
#include "parallel/ranks/ambient_sender.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/ranks/rank_loop.h"
#include "parallel/ranks/trace_work.h"

namespace lightwalk {

/// All ranks have found that the run cannot be; rank 0 has said why.
struct AgreedProblem {
    int status = 1;
    std::string text;  ///< on rank 0: what it has said
};

class RankLink final : private LocalEnd {
  public:
    /// @param program   how messages name the program
    /// @param timeline  whether every span of the timeline is kept
    RankLink(Communicator& communicator, Topology topology, const RankSettings& settings,
             std::string program, bool timeline = false);

    [[nodiscard]] int rank() const { return communicator_.rank(); }
    [[nodiscard]] int ranks() const { return communicator_.size(); }
    [[nodiscard]] bool leads() const { return rank() == 0; }
    [[nodiscard]] bool traces() const { return topology_.traces(rank()); }
    [[nodiscard]] const Topology& topology() const { return topology_; }
    [[nodiscard]] const std::string& host() const { return host_; }
    [[nodiscard]] bool on_one_machine() const { return communicator_.on_one_machine(); }

    /// Runs `body` on a thread of its own, while this thread, which must be the one that opened the
    /// communicator, serves the messages until every rank's body has returned. An exception that
    /// body throws ends the whole run: rank 0 says which rank, its host and the message.
    /// @return  what body returned; kInterruptedStatus when `stop` was requested
    int run(FunctionRef<int()> body, const StopFlag& stop);

    // What follows is called from within body.

    /// Every rank tells what it is about to compute with ("version", digests, ...; one line each),
    /// or why it cannot. Where one cannot, or two differ, rank 0 says so and all throw
    /// AgreedProblem.
    /// @param problem  "" is none
    /// @param status   the exit status that goes with it
    /// @param advice   said by rank 0 where others have a problem that it has not
    void agree(const std::vector<std::string>& facts, const std::string& problem, int status,
               const std::string& advice = "");
    /// Rank 0's bytes, on every rank.
    [[nodiscard]] std::string broadcast(std::string bytes) {
        return loop_.broadcast(std::move(bytes));
    }

    /// From now on new values of the cache go to the other ranks, and it gets theirs, unless none
    /// are exchanged.
    /// @param cache  must outlive this, or the next call
    /// @param known  values of this rank that the others do not have
    void exchange(PublishedCache& cache, const std::vector<AmbientRecord>& known);

    /// Rank 0's values, for the caches of all others. By all ranks, after agree().
    void spread(const std::vector<AmbientRecord>& known, AmbientCache& cache);

    /// Trace what the master gives, until rank 0 says that no more comes.
    void trace(Executor& executor, MakeRenderer make, const StopFlag& stop);
    /// The same for rays.
    void trace_rays(Executor& executor, AnswerChunk answer, const StopFlag& stop);
    /// The same for the frames of a walk.
    /// @param projectors  ranks that own a part of the frames, at most
    void draw_walk(Executor& executor, const CloudOptions& cloud, int projectors,
                   const MakeWalkRays& make, const StopFlag& stop);
    /// On ranks that do not trace.
    void wait_for_end(const StopFlag& stop);
    /// What this rank did, for rank 0.
    void report(std::string text);

    /// The ranks that trace, for one of their tracing threads.
    [[nodiscard]] Group& workers() { return workers_; }

    // On rank 0:
    /// @param checkpoint  what it knows is not traced again; it gets what is. Null: none
    void submit(PictureJob job, const std::shared_ptr<CheckpointSink>& checkpoint = nullptr);
    /// The picture of a job, when it is whole; nothing: stopped. `progress` is called with the
    /// share of the job's pixels that are done.
    [[nodiscard]] std::optional<FinishedPicture> wait_for(JobId job, const StopFlag& stop,
                                                          FunctionRef<void(double)> progress);
    void submit(RayChunk chunk);
    /// What came since the last call.
    struct RayNews {
        std::uint32_t chunks = 0;        ///< that are wanted more
        std::uint32_t rays = 0;          ///< in each, about; 0: as before
        std::vector<RayAnswer> answers;  ///< in the order of the chunks
    };
    /// @param wait  until there is some, or `stop` is requested
    [[nodiscard]] RayNews ray_news(bool wait, const StopFlag& stop);
    /// Gives the order its number.
    void submit(FrameOrder& order);
    /// The frame that was submitted, when all its parts are there; nothing: stopped.
    [[nodiscard]] std::optional<FinishedFrame> wait_for_frame(const StopFlag& stop);
    /// No more work comes: what the other ranks report, by rank.
    [[nodiscard]] std::map<int, std::string> finish(const StopFlag& stop);

    // Several works one after the other: each ends by dismiss(), and another one may begin when
    // all have heard so.

    /// On rank 0: no more of this work comes.
    void dismiss();
    /// On every rank, when it has ended: before the cache of exchange() goes.
    void forget_cache();
    /// The word by which rank 0 tells all ranks what to do next, `said` there; collective: all call
    /// it, when the work before has ended.
    [[nodiscard]] std::string next_command(std::string said = {});

    /// What this rank cannot go on for: ends the whole run.
    void fail(const std::string& text);

    [[nodiscard]] MessageCounts counts() const { return loop_.counts(); }
    [[nodiscard]] const Timeline& timeline() const { return timeline_; }
    /// When agree() returned, which is about the same moment on all ranks.
    [[nodiscard]] Timeline::Clock::time_point agreed() const { return agreed_; }

  private:
    void take(TracerNews news) override { inbox_.push(std::move(news)); }
    void take(ProgramNews news) override;
    void take(AmbientValues news) override;
    [[nodiscard]] AmbientValues unsent_values() override;
    void take(const RankNotice& notice);
    [[nodiscard]] TraceFunctions trace_functions();
    void offer(AmbientValues values);
    [[nodiscard]] std::string named(int rank, const std::string& host) const;
    /// Calls `found()` until it gives something, or `stop` is requested.
    template <class Found>
    auto wait_until(const StopFlag& stop, Found found) -> decltype(found());

    Communicator& communicator_;
    Topology topology_;
    std::string program_, host_;
    Timeline::Clock::time_point agreed_;
    Timeline timeline_;  ///< a row for each tracing thread, the last one for messages
    std::size_t batch_;  ///< 0: no ambient values are exchanged
    TracerInbox inbox_;  ///< what comes for the tracing threads
    RankLoop loop_;
    LoopGroup workers_;
    EncodePiece encode_;
    PublishedCache* cache_ = nullptr;  ///< null: none is there yet
    std::unique_ptr<AmbientSender> sender_;
    FrameNumber last_order_ = 0;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::vector<AmbientRecord> early_values_;
    std::uint32_t scene_ = 0;  ///< see AmbientValues
    std::map<JobId, FinishedPicture> pictures_;
    std::map<JobId, double> shares_;
    std::map<JobId, std::shared_ptr<CheckpointSink>> checkpoints_;
    std::map<int, std::string> reports_;
    RayNews ray_news_;
    std::optional<FinishedFrame> frame_;
};

}  // namespace lightwalk
