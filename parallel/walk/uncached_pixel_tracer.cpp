#include "parallel/walk/uncached_pixel_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lightwalk {
namespace {

constexpr std::size_t kPixelsARun = 32;

}  // namespace

std::chrono::steady_clock::time_point checking_deadline(const FrameClock& clock, double budget,
                                                        double unknown) {
    constexpr double kCalm = 0.4, kBusy = 0.25;  // shares of the budget
    constexpr double kMuchUnknown = 0.3;
    const double share = std::lerp(kCalm, kBusy, std::min(unknown / kMuchUnknown, 1.0));
    return budget > 0 ? clock.in(share * budget) : std::chrono::steady_clock::time_point::max();
}

std::chrono::steady_clock::time_point inferring_deadline(const FrameClock& clock, double budget) {
    constexpr double kMostShare = 0.5;
    return clock.in(kMostShare * budget);
}

std::chrono::steady_clock::time_point tracing_deadline(
    const FrameClock& clock, std::chrono::steady_clock::time_point deadline, double budget,
    double unknown) {
    constexpr double kLeastShare = 0.12, kBlindShare = 0.5;
    return std::max(deadline, clock.in(std::lerp(kLeastShare, kBlindShare, unknown) * budget));
}

void UncachedPixelTracer::trace_part(std::span<const PixelPlace> places, int sample, int worker,
                                     bool at_once, Take take) const {
    std::array<TracedPixel, kPixelsARun> traced;
    std::array<TracedPixelResult, kPixelsARun> uncached;
    std::vector<Rgb> ahead;  // of light groups
    for (std::size_t first = 0; first < places.size(); first += kPixelsARun) {
        if ((first > 0 || !at_once) && is_late()) return;
        const std::size_t count = std::min(kPixelsARun, places.size() - first);
        caster_.trace(places.subspan(first, count), {traced.data(), count}, sample, worker);
        const PixelGroups groups = caster_.groups(worker);
        const std::size_t light_groups = groups.whole.size() / count;
        ahead.resize(groups.whole.size());
        for (std::size_t i = 0; i < count; ++i) {
            uncached[i] = {{traced[i].radiance, traced[i].distance},
                           points_of(traced[i], tolerance_)};
            if (light_groups > 0)
                mix_pixel(traced[i], groups, i,
                          std::span(ahead).subspan(i * light_groups, light_groups), uncached[i]);
        }
        take(first, {{uncached.data(), count}, groups.whole, ahead});
    }
}

void UncachedPixelTracer::trace(std::span<const PixelPlace> places, int sample, Executor& executor,
                                const StopFlag& stop, Take take) const {
    executor.for_each((places.size() + kPixelsARun - 1) / kPixelsARun,
                      [&](std::size_t task, int worker) {
                          const std::size_t begin = task * kPixelsARun;
                          const std::size_t count = std::min(kPixelsARun, places.size() - begin);
                          trace_part(places.subspan(begin, count), sample, worker, task == 0,
                                     [&](std::size_t first, const TracedPixels& traced) {
                                         take(begin + first, traced);
                                     });
                      },
                      stop);
}

}  // namespace lightwalk
