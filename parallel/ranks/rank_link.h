#pragma once
// This process as one of several ranks: its messages are served, and what its program and its
// tracing threads want of other ranks is carried there.
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/math/function_ref.h"
#include "parallel/comm/communicator.h"
#include "parallel/comm/group.h"
#include "parallel/ranks/ambient_exchange.h"
#include "parallel/ranks/pulse.h"
#include "parallel/ranks/rank_report.h"
#include "parallel/ranks/rank_roles.h"
#include "parallel/ranks/tracer_inbox.h"

namespace lightwalk {

/// How soon a rank looks again after a message has come (soon there will be more), and how late at
/// most: each time it finds nothing it waits twice as long. Looking takes some 10 us of a core:
/// where threads have blocks ahead of them, and lose nothing by a later answer, it is done less.
/// Without other ranks nothing comes by itself but a signal's request to stop.
struct Patience {
    std::chrono::microseconds shortest, longest;
};
[[nodiscard]] Patience patience_of(const Topology& topology);

/// All ranks have found that the work cannot be done. Says why on rank 0; without a text on the
/// others.
class AgreedProblem : public InputError {
  public:
    using InputError::InputError;
};

/// Hears which rank could not go on, and why; then the whole run ends. Called by the thread that
/// serves the messages, on the rank that ends the run: rank 0 where it still answers.
using TakeFailure = std::function<void(const std::string& message)>;

class RankLink {
  public:
    /// What mpirun is told of a run that did not end by itself.
    static constexpr int kFailed = 1, kStopped = 130;

    /// @param communicator  must outlive this
    /// @param program       how messages name the program
    /// @param keep_spans    whether every span of the timeline is kept
    RankLink(Communicator& communicator, const Topology& topology, const RankSettings& settings,
             std::string program, TakeFailure failed, bool keep_spans = false);

    [[nodiscard]] int rank() const { return communicator_.rank(); }
    [[nodiscard]] int ranks() const { return communicator_.size(); }
    [[nodiscard]] bool leads() const { return rank() == 0; }
    [[nodiscard]] bool traces() const { return topology_.traces(rank()); }
    [[nodiscard]] const Topology& topology() const { return topology_; }
    [[nodiscard]] bool on_one_machine() const { return communicator_.on_one_machine(); }
    [[nodiscard]] int first_on_machine() const { return communicator_.first_on_machine(); }

    /// Runs `body`, the program, on a thread of its own, while this thread, which must be the one
    /// that opened the communicator, serves the messages until every rank's body has returned; an
    /// AgreedProblem goes on to the caller. Any other exception ends the whole run (TakeFailure),
    /// as do `stop` and, on several machines, a rank that is silent for too long: by
    /// Communicator::abort(), so that this throws Aborted or never returns.
    void run(FunctionRef<void()> body, const StopFlag& stop);

    // What follows is called from within body, and throws Aborted when the run ends meanwhile.

    /// Runs a task of one of this rank's threads; an exception ends the whole run.
    void guard(FunctionRef<void()> task);

    /// A message to a rank, which may be this one. From any thread.
    void post(int to, Message message);
    /// A step of this rank's roles, to be taken by the thread that handles the messages.
    using Step = std::function<void(RankRoles& roles, Outbox& out)>;
    void post(Activity activity, Step step);

    /// Every rank of a group gives bytes and gets everyone's, in the order of the ranks; waits for
    /// the slowest. By one thread at a time, and by all of the group's ranks the same number of
    /// times.
    [[nodiscard]] std::vector<std::string> all_gather(Collective::Group group, std::string bytes);
    /// The same, of numbers, which are added up.
    [[nodiscard]] std::vector<std::uint64_t> all_reduce(Collective::Group group,
                                                        std::vector<std::uint64_t> numbers);
    /// Rank 0's bytes, on every rank; called as all_gather is. Messages are served meanwhile, but
    /// not what this rank's other threads post.
    [[nodiscard]] std::string broadcast(std::string bytes);
    /// The ranks that trace, for one of their tracing threads.
    [[nodiscard]] Group& workers() { return workers_; }
    /// The ranks that trace, and rank 0: where it does not trace it does none of the work. For one
    /// thread of each.
    [[nodiscard]] Group& rounds() { return rounds_; }
    /// All ranks, for one thread of each.
    [[nodiscard]] Group& everyone() { return everyone_; }
    /// Ranks that own parts of a walk's frames.
    [[nodiscard]] const std::vector<int>& owners() const { return owners_; }

    /// Every rank tells what it is about to compute with ("version", digests, ...), or why it
    /// cannot. Where one cannot, or two differ, all throw AgreedProblem.
    /// @param problem  "" is none
    /// @param advice   goes with it where others have a problem that rank 0 has not
    void agree(const std::vector<std::string>& facts, const std::string& problem,
               const std::string& advice = "");

    // Works that all ranks do together, one after the other.

    /// Whether ambient values are exchanged.
    [[nodiscard]] bool exchanges_values() const { return topology_.ambient_master.has_value(); }
    /// Where they are, new values of the cache go to the other ranks from now on, and it gets
    /// theirs. Called by all ranks, after agree(), and by those that trace when a walk's scene
    /// changes; then the cache before is not used any more.
    /// @param cache  must outlive the work, or its scene
    /// @param scene  see AmbientValues
    void share(PublishedCache& cache, std::uint64_t scene = 0) { cache_.open(cache, scene); }
    // On rank 0: the next picture, frame of a walk, change of its scene, or rays.
    void start(Announcement announcement);
    void add(RayChunk chunk);
    /// Numbers pictures and frames, on rank 0.
    [[nodiscard]] std::uint32_t new_number() { return ++last_number_; }
    /// What comes for the threads that trace.
    [[nodiscard]] TracerInbox& inbox() { return inbox_; }
    /// A piece of work is traced; from any of these threads.
    void finish_work(const FinishedWork& finished, TracedWork traced);
    /// On rank 0: what has come for the program since the last call; of other ranks' notices only
    /// reports.
    /// @param wait  until there is something, or `stop` is requested
    [[nodiscard]] std::deque<ProgramNews> take_news(bool wait, const StopFlag& stop);
    /// On rank 0: no more of this work comes, which closes the inboxes of all ranks.
    void dismiss();
    /// By all ranks, when the inbox is closed: all ambient values of this work are told (rank 0 may
    /// keep a file of them), and another one may begin.
    void end_work();

    /// On rank 0, since agree(): how long it takes at least until all have answered [s]; 0 on one
    /// machine.
    [[nodiscard]] double round_trip() const { return round_trip_; }
    /// Its clock, and how its threads wait.
    [[nodiscard]] RankThreads& threads() { return *threads_; }
    [[nodiscard]] Timeline& timeline() { return timeline_; }
    /// What this rank did, but for what only its tracers know. Times are told since agree(), which
    /// returns at about the same moment on all ranks.
    [[nodiscard]] RankReport report() const;

  private:
    /// The ranks that trace.
    class Workers final : public Group {
      public:
        explicit Workers(RankLink& link) : link_(link) {}
        [[nodiscard]] int index() const override;
        [[nodiscard]] int size() const override;
        [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
            return link_.all_gather(Collective::Group::workers, std::move(mine));
        }
        [[nodiscard]] std::vector<std::uint64_t> all_reduce(
            const std::vector<std::uint64_t>& mine) override {
            return link_.all_reduce(Collective::Group::workers, mine);
        }

      private:
        RankLink& link_;
    };
    /// They, and rank 0.
    class Rounds final : public Group {
      public:
        explicit Rounds(RankLink& link) : link_(link) {}
        [[nodiscard]] int index() const override;
        [[nodiscard]] int size() const override { return link_.workers_.size(); }
        [[nodiscard]] int parts() const override;
        [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override;

      private:
        RankLink& link_;
    };
    class Everyone final : public Group {
      public:
        explicit Everyone(RankLink& link) : link_(link) {}
        [[nodiscard]] int index() const override { return link_.rank(); }
        [[nodiscard]] int size() const override { return link_.ranks(); }
        [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
            return link_.all_gather(Collective::Group::all, std::move(mine));
        }

      private:
        RankLink& link_;
    };
    struct Posted {
        Activity activity{};
        Step step;
    };
    struct Operation {
        std::uint32_t round = 0;           ///< of the next one
        std::optional<Collective> result;  ///< of the last one
    };
    struct OwnFailure {
        std::string text;
        std::chrono::steady_clock::time_point patience;  ///< until when rank 0 may end the run
    };

    // The program's threads.
    [[nodiscard]] Collective perform(Collective share);
    void flush_values();
    void watch_others(std::vector<std::string> hosts);
    void meet() { (void)all_gather(Collective::Group::all, {}); }
    [[noreturn]] void fail(const std::string& text);

    // The thread that handles the messages.
    void handle_messages(const StopFlag& stop);
    [[nodiscard]] bool goes_on();
    [[nodiscard]] bool run_posted();
    [[nodiscard]] bool handle_arrived();
    void exchange_values_in_time();
    void keep_pulse();
    void note_flushed();
    void tell(RankRoles& roles, Outbox& out);
    void take_step(Activity activity, const Step& step);
    void dispatch(Outbox first);
    void hand_out(Outbox& out);
    void push_news(ProgramNews news);
    void end_run(int rank, const std::string& host, const std::string& text);
    [[nodiscard]] std::string named(int rank, const std::string& host) const;

    Communicator& communicator_;
    std::shared_ptr<RankThreads> threads_;
    Topology topology_;
    std::string program_, host_;
    TakeFailure failed_;
    Timeline timeline_;  ///< a row for each tracing thread, the last one for messages
    Patience patience_;
    RankRoles roles_;
    Pulse pulse_;
    std::vector<std::string> hosts_;  ///< by rank; "": not told yet
    std::vector<int> owners_;
    Workers workers_{*this};
    Rounds rounds_{*this};
    Everyone everyone_{*this};
    TracerInbox inbox_;
    SharedCache cache_;
    std::chrono::steady_clock::time_point exchanged_;  ///< when values were, last
    double agreed_ = 0;                                ///< on the timeline
    double round_trip_ = 0;                            ///< see round_trip()
    std::uint32_t last_number_ = 0;

    mutable std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::deque<Posted> posted_;
    std::array<Operation, kGroups> operations_;  ///< by group
    std::optional<std::string> broadcast_;       ///< what came of it
    std::deque<ProgramNews> news_;
    MessageCounts counts_;
    std::optional<OwnFailure> failure_;
    bool flushing_ = false;  ///< somebody waits until the ambient values are told
    bool ended_ = false;     ///< every rank's body has returned
    bool over_ = false;      ///< nothing is served any more
};

}  // namespace lightwalk
