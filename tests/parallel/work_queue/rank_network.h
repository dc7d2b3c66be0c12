#pragma once
// The roles of all ranks in one thread, on a random schedule: messages between ranks are delayed
// and reordered.
#include <cstring>
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

/// One of a list, for random options.
inline int one_of(std::mt19937_64& random, std::initializer_list<int> list) {
    return *(list.begin() + static_cast<std::ptrdiff_t>(random() % list.size()));
}

}  // namespace lightwalk::test
