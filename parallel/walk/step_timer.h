#pragma once
// How long a step of a frame takes.
#include <chrono>

namespace lightwalk {

/// Adds the time until it goes.
class StepTimer {
  public:
    using Clock = std::chrono::steady_clock;
    explicit StepTimer(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
    ~StepTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    StepTimer(const StepTimer&) = delete;
    StepTimer& operator=(const StepTimer&) = delete;

  private:
    double& seconds_;
    Clock::time_point start_;
};

}  // namespace lightwalk
