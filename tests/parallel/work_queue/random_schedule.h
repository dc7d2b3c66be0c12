#pragma once
// What happens when, for tests of ranks in one thread: actions in the order of their times, and
// messages that arrive after random delays, in order between any two ranks, else in any order.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <tuple>
#include <utility>

#include "parallel/work_queue/message.h"

namespace lightwalk::test {

class RandomSchedule {
  public:
    explicit RandomSchedule(std::uint64_t seed) : random_(seed) {}

    /// Uniform in [0, most).
    double uniform(double most) { return std::uniform_real_distribution<double>(0, most)(random_); }
    /// Uniform in 0 ... 2^64 - 1.
    std::uint64_t number() { return random_(); }

    void after(double seconds, std::function<void()> act) { at(now_ + seconds, std::move(act)); }

    /// `deliver(Envelope)` for each message, between ranks after up to `longest_delay`.
    template <class Deliver>
    void carry(std::vector<Envelope>& out, double longest_delay, Deliver deliver) {
        for (Envelope& envelope : out) {
            const bool local = envelope.from == envelope.to;
            double& last = last_[{envelope.from, envelope.to}];
            last = std::max(last, now_ + (local ? 0 : uniform(longest_delay)));
            const auto carried = std::make_shared<Envelope>(std::move(envelope));
            at(last, [deliver, carried] { deliver(std::move(*carried)); });
        }
        out.clear();
    }

    /// Until nothing is left to happen.
    void run() {
        while (!events_.empty()) {
            const Event event = events_.top();
            events_.pop();
            now_ = event.time;
            event.act();
        }
    }

  private:
    struct Event {
        double time = 0;
        std::uint64_t number = 0;
        std::function<void()> act;
        bool operator<(const Event& other) const {
            return std::tie(time, number) > std::tie(other.time, other.number);
        }
    };

    void at(double time, std::function<void()> act) {
        events_.push({time, next_++, std::move(act)});
    }

    std::mt19937_64 random_;
    std::priority_queue<Event> events_;
    std::map<std::pair<int, int>, double> last_;  ///< arrivals, by rank from and to
    double now_ = 0;
    std::uint64_t next_ = 0;
};

}  // namespace lightwalk::test
