#pragma once
// The time by which frames keep their budgets.
#include <chrono>
#include <functional>
#include <utility>

namespace lightwalk {

/// Tells what time it is: the machine's steady clock, or that of a simulation, where time passes
/// only while nobody has anything to do.
class FrameClock {
  public:
    using Clock = std::chrono::steady_clock;

    FrameClock() = default;
    /// @param now  instead of the machine's; called by many threads
    explicit FrameClock(std::function<Clock::time_point()> now) : now_(std::move(now)) {}

    [[nodiscard]] Clock::time_point now() const { return now_ ? now_() : Clock::now(); }
    /// The moment when so many seconds will have passed.
    [[nodiscard]] Clock::time_point in(double seconds) const {
        const std::chrono::duration<double> span(seconds);
        return now() + std::chrono::duration_cast<Clock::duration>(span);
    }

  private:
    std::function<Clock::time_point()> now_;
};

}  // namespace lightwalk
