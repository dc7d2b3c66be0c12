#include "tests/simulation/network.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "parallel/work_queue/message.h"

namespace lightwalk::simulation {

/// One rank's end of the network.
class SimulatedCommunicator final : public Communicator {
  public:
    SimulatedCommunicator(World& world, Network& network, int rank)
        : world_(world), network_(network), own_(network.rank_of(rank)), rank_(rank) {}

    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int size() const override { return world_.ranks(); }
    [[nodiscard]] std::string host() const override { return "host" + std::to_string(rank_); }
    [[nodiscard]] bool on_one_machine() const override { return false; }
    [[nodiscard]] int first_on_machine() const override { return rank_; }

    void send(int to, std::string bytes) override { network_.send({rank_, to, std::move(bytes)}); }

    [[nodiscard]] std::optional<Packet> receive() override {
        if (own_.inbox.empty()) return std::nullopt;
        Packet first = std::move(own_.inbox.front());
        own_.inbox.pop_front();
        return first;
    }

    void wait(std::chrono::microseconds most) override {
        if (own_.inbox.empty() && !own_.woken)
            world_.wait(&own_.inbox, world_.now() + std::max<Time>(most, World::kCoarse));
        own_.woken = false;
    }

    void wake() override {
        own_.woken = true;
        world_.wake(&own_.inbox);
    }

    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        if (rank_ == 0) {
            for (int to = 1; to < size(); ++to) {
                network_.carry(0, to, [&rank = network_.rank_of(to), &world = world_, bytes] {
                    rank.broadcasts.push_back(bytes);
                    world.wake(&rank.broadcasts);
                });
            }
            return bytes;
        }
        while (own_.broadcasts.empty()) {
            world_.wait(&own_.broadcasts, world_.now() + World::kCoarse);
            meanwhile();
        }
        std::string got = std::move(own_.broadcasts.front());
        own_.broadcasts.pop_front();
        return got;
    }

    void flush() override {}

    [[noreturn]] void abort(int) override {
        network_.end_all(rank_);
        throw Killed();
    }

  private:
    World& world_;
    Network& network_;
    Network::Rank& own_;
    int rank_;
};

Network::Network(World& world, Time longest)
    : world_(world),
      longest_(longest),
      ranks_(static_cast<std::size_t>(world.ranks())),
      ways_(ranks_.size() * ranks_.size()) {}

std::unique_ptr<Communicator> Network::end(int rank) {
    return std::make_unique<SimulatedCommunicator>(world_, *this, rank);
}

void Network::cut(int rank) {
    rank_of(rank).cut = true;
}

void Network::unplug(int rank, Time until) {
    rank_of(rank).unplugged_until = std::max(rank_of(rank).unplugged_until, until);
}

void Network::end_all(int by) {
    constexpr Time kSoon = seconds(1);
    world_.kill(by);
    for (int rank = 0; rank < world_.ranks(); ++rank) {
        if (rank == by || is_cut(by)) continue;
        world_.at(world_.now() + world_.chance().up_to(kSoon), [this, rank] {
            if (!is_cut(rank)) world_.kill(rank);
        });
    }
}

void Network::send(Packet packet) {
    ++sent_;
    for (std::size_t i = 0; i < moments_.size(); ++i)
        if (moments_[i].messages == sent_) moments_[i].act();
    const int copies = mishap_ ? mishap_(packet) : 1;
    for (int copy = 0; copy < copies; ++copy) {
        const int from = packet.from, to = packet.to;
        carry(from, to, [this, packet] { deliver(packet); });
    }
}

void Network::carry(int from, int to, std::function<void()> arrive) {
    Way& way = way_between(from, to);
    way.last = std::max(way.last, world_.now() + world_.chance().up_to(longest_));
    way.messages.push_back(std::move(arrive));
    arrive_at(way.last, from, to);
}

/// The way's first message, that is: of two that arrive at one time.
void Network::arrive_at(Time when, int from, int to) {
    world_.at(when, [this, from, to] {
        const Time later = std::max(rank_of(from).unplugged_until, rank_of(to).unplugged_until);
        if (later > world_.now()) return arrive_at(later, from, to);
        Way& way = way_between(from, to);
        const std::function<void()> arrive = std::move(way.messages.front());
        way.messages.pop_front();
        if (!is_cut(from) && !is_cut(to)) arrive();
    });
}

void Network::deliver(const Packet& packet) {
    Rank& to = rank_of(packet.to);
    if (to.left && !world_.killed(packet.to)) {
        const Message message = decode_message(packet.bytes);
        const auto* notice = std::get_if<Notice>(&message);
        if (notice != nullptr && std::holds_alternative<Alive>(notice->notice)) return;
        late_ = kind_name(message.index());
        return;
    }
    to.inbox.push_back({packet.from, packet.bytes});
    world_.wake(&to.inbox);
}

}  // namespace lightwalk::simulation
