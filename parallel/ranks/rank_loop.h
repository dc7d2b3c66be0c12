#pragma once
// One rank's messages, served: by its roles, and by what is within it.
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "parallel/comm/communicator.h"
#include "parallel/comm/group.h"
#include "parallel/ranks/message_counts.h"
#include "parallel/ranks/rank_roles.h"
#include "parallel/ranks/timeline.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

/// What within a rank is no role: its program, its tracing threads, its ambient cache. Called by
/// the thread that serves the messages, which must not wait here.
class LocalEnd {
  public:
    virtual ~LocalEnd() = default;
    virtual void take(TracerNews news) = 0;
    virtual void take(ProgramNews news) = 0;
    virtual void take(AmbientValues news) = 0;
    /// Ambient values that were made here and wait to be sent; asked for every second and at the
    /// end.
    [[nodiscard]] virtual AmbientValues unsent_values() { return {}; }
};

/// How soon a rank's loop looks again after a message has come (soon there will be more), and how
/// late at most: each time it finds nothing it waits twice as long. Looking takes some 10 us of a
/// core: where threads have blocks ahead of them, and lose nothing by a later answer, it is done
/// less. Without other ranks nothing comes by itself but a signal's request to stop.
struct Patience {
    std::chrono::microseconds shortest, longest;
};
[[nodiscard]] Patience patience_of(const Topology& topology);

/// Serves the messages of one rank on the thread that calls run(). Where nothing is to be done it
/// sleeps: it takes no core from those who trace.
class RankLoop {
  public:
    /// All must outlive this.
    /// @param timeline  whose last row is this loop's; null: none
    RankLoop(Communicator& communicator, const Topology& topology, const RankSettings& settings,
             LocalEnd& local, Timeline* timeline = nullptr);

    /// A message to a rank, which may be this one. From any thread.
    void post(int to, Message message);
    /// A step of this rank's roles, to be taken by the loop's thread. From any thread.
    using Step = std::function<void(RankRoles& roles, Outbox& out)>;
    void post(Activity activity, Step step);

    /// Every rank of a group gives bytes and gets everyone's, in the order of the ranks; waits for
    /// the slowest. From any thread but the one that runs run(), by one thread at a time, and by
    /// all of the group's ranks the same number of times. Throws Aborted when the loop ends before.
    [[nodiscard]] std::vector<std::string> all_gather(Collective::Group group, std::string bytes);
    /// The same, of numbers, which are added up.
    [[nodiscard]] std::vector<std::uint64_t> all_reduce(Collective::Group group,
                                                        std::vector<std::uint64_t> numbers);
    /// Rank 0's bytes, on every rank; called as all_gather is. This rank's messages wait meanwhile.
    [[nodiscard]] std::string broadcast(std::string bytes);

    /// Until end() is called, or `stop` is requested. Requests the first work by itself.
    /// False: stopped.
    [[nodiscard]] bool run(const StopFlag& stop);
    /// This rank has no more to say, from any thread. Its loop ends when all ranks' have been told
    /// so, and nothing is on its way to anyone any more.
    void end();

    /// What this rank has sent so far; from any thread.
    [[nodiscard]] MessageCounts counts() const {
        const std::lock_guard lock(counts_mutex_);
        return counts_;
    }

  private:
    void advance_shutdown();
    void exchange_values_in_time();
    void exchange_values();
    void serve_broadcast();
    [[nodiscard]] bool serve_posted();
    [[nodiscard]] bool serve_arrived();
    void take_step(Activity activity, const Step& step);
    void dispatch(Outbox first);
    void hand_out(Outbox& out);
    void conclude(Collective result);
    [[nodiscard]] Collective perform(Collective share);

    Communicator& communicator_;
    Topology topology_;
    LocalEnd& local_;
    Timeline* timeline_;
    bool draws_walks_;
    RankRoles roles_;
    mutable std::mutex counts_mutex_;
    MessageCounts counts_;                             ///< guarded by it
    std::chrono::steady_clock::time_point exchanged_;  ///< when values were, last

    struct Posted {
        Activity activity{};
        Step step;
    };
    struct Operation {
        std::uint32_t round = 0;           ///< of the next one
        std::optional<Collective> result;  ///< of the last one
    };
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable answered_;
    std::deque<Posted> posted_;
    bool ended_ = false;                         ///< by this rank
    bool over_ = false;                          ///< the loop
    std::array<Operation, kGroups> operations_;  ///< by group
    std::optional<std::string> to_broadcast_, broadcast_;

    /// The end comes in two rounds of all ranks. Before the first each rank that has ended tells
    /// its last ambient values; then rank 0, which may keep a file of them, hears these. After the
    /// second nothing is on its way to anyone.
    enum class ShutdownPhase {
        none,      ///< this rank has not ended
        telling,   ///< its last ambient values
        told,      ///< waits until all have
        all_told,  ///< all have
        hearing,   ///< what the others told
        waiting,   ///< until all have heard
        over,
    };
    ShutdownPhase shutdown_ = ShutdownPhase::none;
};

/// The ranks that trace.
class LoopGroup final : public Group {
  public:
    LoopGroup(RankLoop& loop, const Topology& topology, int rank)
        : loop_(loop),
          index_(static_cast<int>(topology.worker_index(rank).value_or(0))),
          size_(static_cast<int>(topology.workers.size())) {}
    [[nodiscard]] int index() const override { return index_; }
    [[nodiscard]] int size() const override { return size_; }
    [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
        return loop_.all_gather(Collective::Group::workers, std::move(mine));
    }
    [[nodiscard]] std::vector<std::uint64_t> all_reduce(
        const std::vector<std::uint64_t>& mine) override {
        return loop_.all_reduce(Collective::Group::workers, mine);
    }

  private:
    RankLoop& loop_;
    int index_, size_;
};

}  // namespace lightwalk
