#pragma once
// How long a step of a frame takes.
#include <chrono>

#include "parallel/walk/frame_clock.h"

namespace lightwalk {

/// Adds the time until it goes.
class StepTimer {
  public:
    /// Both must outlive it.
    StepTimer(double& seconds, const FrameClock& clock)
        : seconds_(seconds), clock_(clock), start_(clock.now()) {}
    ~StepTimer() { seconds_ += std::chrono::duration<double>(clock_.now() - start_).count(); }
    StepTimer(const StepTimer&) = delete;
    StepTimer& operator=(const StepTimer&) = delete;

  private:
    double& seconds_;
    const FrameClock& clock_;
    FrameClock::Clock::time_point start_;
};

}  // namespace lightwalk
