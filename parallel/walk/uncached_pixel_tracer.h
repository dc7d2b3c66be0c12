#pragma once
// Pixels that no point answers, traced: by the threads of an executor, until a frame's time is
// over.
#include <chrono>
#include <cstddef>
#include <span>
#include <utility>

#include "core/cloud/primary_visibility.h"
#include "core/cloud/trace_list.h"
#include "core/math/function_ref.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/frame_clock.h"

namespace lightwalk {

/// When looking at the pixels has to end in a frame that has a budget and looks from now on.
/// @param unknown  share of the pixels that no point answered in the frame before: where much comes
///                 into view it has to be traced; else the time is better spent on what points
///                 show, as some shine through what is in front of them
[[nodiscard]] std::chrono::steady_clock::time_point checking_deadline(const FrameClock& clock,
                                                                      double budget,
                                                                      double unknown);

/// When pixels that were not traced are no longer looked at, in a frame of a budget that begins to
/// do so now. Without them it would show colours of other surfaces there.
[[nodiscard]] std::chrono::steady_clock::time_point inferring_deadline(const FrameClock& clock,
                                                                       double budget);
/// When tracing has to end in a frame that has a budget and should be there at `deadline`. Where
/// other steps have taken the time, some is left for tracing all the same: else nothing new would
/// ever be seen.
/// @param unknown  share of the pixels that no point answers: the larger it is, the more is left
[[nodiscard]] std::chrono::steady_clock::time_point tracing_deadline(
    const FrameClock& clock, std::chrono::steady_clock::time_point deadline, double budget,
    double unknown);

class UncachedPixelTracer {
  public:
    using Clock = std::chrono::steady_clock;
    /// Gets pixels `first` ... that were traced; called by many threads.
    using Take = FunctionRef<void(std::size_t first, const TracedPixels& traced)>;

    /// @param tolerance  see points_of
    /// The caster must outlive this.
    UncachedPixelTracer(PixelCaster& caster, double tolerance, Clock::time_point deadline,
                        FrameClock clock = {})
        : caster_(caster), tolerance_(tolerance), deadline_(deadline), clock_(std::move(clock)) {}

    /// Trace pixels by all threads. After the deadline no more are begun, but some are at once.
    void trace(std::span<const PixelPlace> places, int sample, Executor& executor,
               const StopFlag& stop, Take take) const;
    /// Trace pixels by one thread, some tens at a time, until the deadline.
    /// @param at_once  the first of them whatever the time is
    void trace_part(std::span<const PixelPlace> places, int sample, int worker, bool at_once,
                    Take take) const;
    [[nodiscard]] bool is_late() const { return clock_.now() > deadline_; }

  private:
    PixelCaster& caster_;
    double tolerance_;
    Clock::time_point deadline_;
    FrameClock clock_;
};

}  // namespace lightwalk
