#pragma once
// The roles of all ranks in one thread, on a random schedule: messages between ranks are delayed
// and reordered.
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "parallel/ranks/rank_roles.h"
#include "tests/parallel/work_queue/random_schedule.h"

namespace lightwalk::test {

/// Tests derive from it what traces, and the program of rank 0.
class RankNetwork {
  public:
    RankNetwork(const Topology& topology, const RankSettings& settings, double longest_delay,
                std::uint64_t seed)
        : topology_(topology), schedule_(seed), longest_delay_(longest_delay) {
        for (int rank = 0; rank < topology.ranks; ++rank)
            roles_.emplace_back(rank, topology, settings);
    }
    virtual ~RankNetwork() = default;
    RankNetwork(const RankNetwork&) = delete;
    RankNetwork& operator=(const RankNetwork&) = delete;

    /// The first requests of all ranks.
    void begin() {
        for (int rank = 0; rank < topology_.ranks; ++rank)
            step(rank, [](RankRoles& roles, Outbox& out) { roles.begin(out); });
    }
    /// `take(roles, out)` at a rank.
    template <class Take>
    void step(int rank, Take take) {
        Outbox out;
        take(roles(rank), out);
        hand_out(rank, std::move(out));
    }
    void post(int from, int to, Message message) {
        Outbox out;
        out.messages.push_back({from, to, std::move(message)});
        hand_out(from, std::move(out));
    }
    /// Until no message is on its way and nobody traces.
    void run() { schedule_.run(); }

    [[nodiscard]] RankRoles& roles(int rank) { return roles_[static_cast<std::size_t>(rank)]; }
    [[nodiscard]] const Topology& topology() const { return topology_; }
    [[nodiscard]] RandomSchedule& schedule() { return schedule_; }
    std::uint64_t messages_to_rank_0 = 0;  ///< from others

  protected:
    virtual void take(int rank, TracerNews news) = 0;
    virtual void take(ProgramNews news) = 0;
    virtual void take(int, AmbientValues) {}

  private:
    void hand_out(int rank, Outbox out) {
        for (TracerNews& news : out.tracers) take(rank, std::move(news));
        for (ProgramNews& news : out.program) take(std::move(news));
        for (AmbientValues& news : out.cache) take(rank, std::move(news));
        for (const Envelope& envelope : out.messages)
            messages_to_rank_0 += envelope.to == 0 && envelope.from != 0 ? 1 : 0;
        schedule_.carry(out.messages, longest_delay_, [this](Envelope envelope) {
            step(envelope.to, [&](RankRoles& roles, Outbox& next) {
                roles.handle(envelope.from, std::move(envelope.message), next);
            });
        });
    }

    Topology topology_;
    RandomSchedule schedule_;
    double longest_delay_;
    std::vector<RankRoles> roles_;
};

/// The threads of ranks that trace: pieces of work wait for a free one, and take random times.
template <class Piece>
class TracingThreads {
  public:
    /// @param slots  threads of each rank
    TracingThreads(int ranks, int slots, RandomSchedule& schedule)
        : ranks_(static_cast<std::size_t>(ranks), Rank{slots, {}}), schedule_(schedule) {}
    /// Pieces at a rank that no thread has begun.
    [[nodiscard]] std::deque<Piece>& waiting(int rank) {
        return ranks_[static_cast<std::size_t>(rank)].waiting;
    }
    /// Free threads of a rank begin what waits; `finish(piece, seconds)` comes up to `longest`
    /// later.
    template <class Finish>
    void trace(int rank, double longest, Finish finish) {
        Rank& own = ranks_[static_cast<std::size_t>(rank)];
        while (own.free_slots > 0 && !own.waiting.empty()) {
            --own.free_slots;
            const auto piece = std::make_shared<Piece>(std::move(own.waiting.front()));
            own.waiting.pop_front();
            const double seconds = schedule_.uniform(longest);
            schedule_.after(seconds, [this, rank, longest, finish, piece, seconds] {
                ++ranks_[static_cast<std::size_t>(rank)].free_slots;
                finish(*piece, seconds);
                trace(rank, longest, finish);
            });
        }
    }

  private:
    struct Rank {
        int free_slots = 1;
        std::deque<Piece> waiting;
    };
    std::vector<Rank> ranks_;
    RandomSchedule& schedule_;
};

/// One of a list, for random options.
inline int one_of(std::mt19937_64& random, std::initializer_list<int> list) {
    return *(list.begin() + static_cast<std::ptrdiff_t>(random() % list.size()));
}

}  // namespace lightwalk::test
