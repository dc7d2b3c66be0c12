#pragma once
// Whether the other ranks are still there.
#include <chrono>
#include <optional>
#include <vector>

namespace lightwalk {

/// Every rank tells rank 0, and rank 0 every rank, now and then that it is there: a host that is
/// switched off or cut off closes no connection, and messages to it are merely not answered. Rank 0
/// watches all others, and they watch rank 0. A pure step each: the time is told.
class Pulse {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;
    struct Times {
        Duration every = std::chrono::seconds(2);     ///< a rank tells that it is there
        Duration silence = std::chrono::seconds(30);  ///< after which it is taken for lost
    };

    Pulse(int rank, int ranks, const Times& times) : rank_(rank), ranks_(ranks), times_(times) {}

    /// From now on. All ranks do so at about the same time, or later than rank 0 by less than the
    /// silence that is allowed.
    void start(Time now);
    /// A message has come; any kind tells that its sender is there.
    void heard(int from, Time now);

    struct Beat {
        bool due = false;         ///< whether to tell the others now
        std::optional<int> lost;  ///< a rank that has been silent for too long
    };
    /// To be called at least as often as ranks tell that they are there. Where it was not, this
    /// process did not run meanwhile, and nothing is known of the others' silence.
    [[nodiscard]] Beat beat(Time now);

    [[nodiscard]] Duration silence() const { return times_.silence; }

  private:
    int rank_, ranks_;
    Times times_;
    bool started_ = false;
    Time looked_, told_;
    std::vector<Time> heard_;  ///< last, by rank
};

}  // namespace lightwalk
