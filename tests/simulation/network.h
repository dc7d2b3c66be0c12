#pragma once
// What lies between simulated ranks: messages with delays, hosts that are cut off, mpirun.
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "parallel/comm/communicator.h"
#include "tests/simulation/world.h"

namespace lightwalk::simulation {

/// A message as the network sees it.
struct Packet {
    int from = 0, to = 0;
    std::string bytes;
};

/// What may befall a message, where a test plants a fault: it may change it, and says how often it
/// arrives. Without one each arrives once, as it is.
using Mishap = std::function<int(Packet& packet)>;

class Network {
  public:
    /// @param longest  delay of a message
    Network(World& world, Time longest);

    [[nodiscard]] std::unique_ptr<Communicator> end(int rank);

    /// A rank's host is switched off, or its cable is pulled for good: nothing comes to it or from
    /// it any more, what is under way neither.
    void cut(int rank);
    /// A rank's cable is pulled, until then: what is under way, or sent, arrives later.
    void unplug(int rank, Time until);
    /// A process ends: so do all the others that mpirun reaches, soon. A host that is cut off is
    /// not reached, and mpirun does not notice that it is.
    void end_all(int by);
    /// The rank has returned from its run: nothing but signs of life may come for it any more.
    void left(int rank) { rank_of(rank).left = true; }

    [[nodiscard]] bool is_cut(int rank) const { return ranks_[static_cast<std::size_t>(rank)].cut; }
    /// What came for ranks after their end, but for signs of life.
    [[nodiscard]] const std::string& late() const { return late_; }
    /// Calls `act` once so many messages have been sent.
    void after_messages(std::uint64_t count, std::function<void()> act) {
        moments_.push_back({count, std::move(act)});
    }
    void set_mishap(Mishap mishap) { mishap_ = std::move(mishap); }

    [[nodiscard]] std::uint64_t sent() const { return sent_; }

  private:
    friend class SimulatedCommunicator;
    struct Rank {
        bool cut = false, left = false, woken = false;
        Time unplugged_until{};
        std::deque<Communicator::Packet> inbox;
        std::deque<std::string> broadcasts;
    };
    struct Way {
        Time last{};  ///< arrival
        std::deque<std::function<void()>> messages;
    };
    struct Moment {
        std::uint64_t messages = 0;
        std::function<void()> act;
    };
    [[nodiscard]] Rank& rank_of(int rank) { return ranks_[static_cast<std::size_t>(rank)]; }
    /// Calls `arrive` when what `from` sends `to` now does, after all that it has sent it before.
    void carry(int from, int to, std::function<void()> arrive);
    void arrive_at(Time when, int from, int to);
    [[nodiscard]] Way& way_between(int from, int to) {
        return ways_[static_cast<std::size_t>(from) * ranks_.size() + static_cast<std::size_t>(to)];
    }
    void send(Packet packet);
    void deliver(const Packet& packet);

    World& world_;
    Time longest_;
    std::vector<Rank> ranks_;
    std::vector<Way> ways_;  ///< by rank from and to
    std::vector<Moment> moments_;
    Mishap mishap_;
    std::string late_;
    std::uint64_t sent_ = 0;
};

}  // namespace lightwalk::simulation
