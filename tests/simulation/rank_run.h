#pragma once
// A run of simulated ranks: the real link and roles, what befalls the ranks, and whether the run
// ends, or goes on, as promised. What the ranks draw together is said by who derives from it.
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "parallel/ranks/rank_link.h"
#include "tests/simulation/network.h"
#include "tests/simulation/world.h"

namespace lightwalk::simulation {

/// What befalls one rank.
struct Fault {
    enum class Kind {
        stop,       ///< its process does not run for a while
        unplug,     ///< its cable is pulled for a while
        kill,       ///< its process ends
        cut,        ///< its host is gone
        fail,       ///< the next piece of work that it traces cannot be traced
        interrupt,  ///< somebody interrupts it
    };
    Kind kind = Kind::stop;
    int rank = 0;
    std::uint64_t message = 0;  ///< once so many have been sent; 0: see time
    Time time{};
    Time lasts{};

    [[nodiscard]] bool passes() const { return kind == Kind::stop || kind == Kind::unplug; }
};

/// A run of ranks.
struct RankPlan {
    Variant variant = Variant::ranks;
    int ranks = 4, masters = 1;
    int slots = 1, ahead = 1;
    Time longest_delay = milliseconds(1);   ///< of a message
    Time longest_work = milliseconds(100);  ///< on a piece of it
    bool broadcasts = false;                ///< something before the work begins
    std::vector<Fault> faults;
};
/// The ranks, and what follows of a plan: `what` is of the kind of run.
[[nodiscard]] std::string description_of(const RankPlan& plan, const std::string& what);
[[nodiscard]] double in_seconds(Time time);

/// Errors that are planted, to see that they are found.
struct Planted {
    Mishap mishap;               ///< null: none
    bool forgets_known = false;  ///< the master does not pass on one of the blocks that it kept
    bool never_loses_patience = false;  ///< nobody watches others' silence
};

/// How a run ended, and what it did.
struct Outcome {
    bool ended = false;                 ///< before the world's time was over
    bool finished = false;              ///< with all that was to be drawn, on all ranks
    std::vector<std::string> failures;  ///< that ranks told
    std::string wrong;                  ///< "": nothing
    Time end{}, last_fault{};
    std::uint64_t messages = 0;
};

class RankRun {
  public:
    virtual ~RankRun() = default;
    RankRun(const RankRun&) = delete;
    RankRun& operator=(const RankRun&) = delete;
    [[nodiscard]] Outcome play();

  protected:
    /// All but the seed must outlive this.
    RankRun(Fibers& fibers, const RankPlan& plan, const Planted& planted, std::uint64_t seed);

    /// What is drawn needs other settings.
    virtual void change(RankSettings& settings) const = 0;
    /// The work of rank 0's program, until all is drawn or it is interrupted.
    virtual void lead(RankLink& link) = 0;
    /// What a rank that traces does until no more work comes.
    virtual void trace(RankLink& link) = 0;
    /// Rank 0 hears of it.
    virtual void take(ProgramNews news) = 0;
    [[nodiscard]] virtual bool all_drawn() const = 0;

    /// On rank 0: waits for news, and takes them.
    void take_some(RankLink& link);
    /// One piece of it: takes time. Throws where the rank is to fail.
    void work_a_while(int rank);
    [[nodiscard]] const StopFlag& stop_of(int rank) const {
        return stop_[static_cast<std::size_t>(rank)];
    }
    void complain(std::string text) {
        if (outcome_.wrong.empty()) outcome_.wrong = std::move(text);
    }

    const Planted& planted_;
    World world_;
    Network network_;
    Topology topology_;
    std::shared_ptr<WorldThreads> threads_;

  private:
    void plant_faults();
    void befall(const Fault& fault);
    void play_rank(int rank);
    [[nodiscard]] RankSettings settings() const;
    void program(RankLink& link);
    void lead_and_dismiss(RankLink& link);
    void take_report(const RankNotice& told);
    void check_end();

    const RankPlan& plan_;
    std::vector<StopFlag> stop_;  ///< by rank
    std::vector<bool> fails_;     ///< by rank: see Fault::Kind::fail
    std::vector<int> reports_;    ///< by rank
    int left_ = 0;                ///< ranks that have returned
    bool may_end_ = false;        ///< something has befallen a rank that no run has to bear
    Time silent_{};               ///< how long ranks were, one after the other
    Outcome outcome_;
};

}  // namespace lightwalk::simulation
