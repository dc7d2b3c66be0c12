#pragma once
// Collective operations of processes that compute together.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "parallel/comm/wire.h"

namespace lightwalk {

/// The processes of a group call each operation in the same order; it waits for the slowest.
class Group {
  public:
    Group() = default;
    virtual ~Group() = default;
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;

    /// Of this process, 0 ... size() - 1; -1: it does none of the work, but hears what comes of it.
    [[nodiscard]] virtual int index() const = 0;
    [[nodiscard]] virtual int size() const = 0;  ///< of those that work
    /// Of those that meet.
    [[nodiscard]] virtual int parts() const { return size(); }
    /// Everyone's bytes, in the order of their indices; last, those of who does none of the work.
    [[nodiscard]] virtual std::vector<std::string> all_gather(std::string mine) = 0;
    /// Everyone's numbers, added up one by one; all give as many.
    [[nodiscard]] virtual std::vector<std::uint64_t> all_reduce(
        const std::vector<std::uint64_t>& mine) {
        std::vector<std::uint64_t> sums(mine.size());
        for (const std::string& one : all_gather(wire::encode(mine))) {
            const auto numbers = wire::decode<std::vector<std::uint64_t>>(one);
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += numbers.at(i);
        }
        return sums;
    }

    /// Whether this process does the i-th part of the work.
    [[nodiscard]] bool does(std::size_t i) const {
        return i % static_cast<std::size_t>(size()) == static_cast<std::size_t>(index());
    }
};

/// How long it takes at least until all have answered [s]. By all processes of the group.
[[nodiscard]] inline double shortest_round_trip(Group& group) {
    using Clock = std::chrono::steady_clock;
    constexpr int kRounds = 4;
    auto shortest = Clock::duration::max();
    for (int i = 0; i < kRounds; ++i) {
        const Clock::time_point start = Clock::now();
        (void)group.all_gather({});
        shortest = std::min(shortest, Clock::now() - start);
    }
    return std::chrono::duration<double>(shortest).count();
}

/// A process by itself.
class GroupOfOne final : public Group {
  public:
    [[nodiscard]] int index() const override { return 0; }
    [[nodiscard]] int size() const override { return 1; }
    [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
        return {std::move(mine)};
    }
};

}  // namespace lightwalk
