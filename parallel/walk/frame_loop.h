#pragma once
// A frame of a walk, or the part of it that one process owns: one function, for one process and for
// many.
#include <optional>
#include <span>
#include <utility>

#include "core/cloud/primary_visibility.h"
#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_region.h"
#include "parallel/walk/frame_clock.h"
#include "parallel/walk/frame_order.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {

/// What the owners of a frame's parts have to do with each other. Functions that wait for others
/// return false, or nothing, when they are stopped.
class FrameExchange {
  public:
    FrameExchange() = default;
    virtual ~FrameExchange() = default;
    FrameExchange(const FrameExchange&) = delete;
    FrameExchange& operator=(const FrameExchange&) = delete;

    /// Points that the frame shows in other parts go there, and those of others come.
    [[nodiscard]] virtual bool exchange_points(CloudRegion& region, const StopFlag& stop) = 0;
    /// Tells the owners beside this one which of their points were used here.
    virtual void send_used(const CloudRegion& region) = 0;
    /// All uncached pixels of the region are traced, or known to be too late, and it is known which
    /// of its points others used.
    [[nodiscard]] virtual bool trace(CloudRegion& region, const UncachedPixelTracer& tracer,
                                     int sample, Executor& executor, const StopFlag& stop) = 0;
    /// The part is drawn.
    virtual void deliver(const FrameOrder& order, CloudRegion& region) = 0;
    /// The ages of all parts' points.
    [[nodiscard]] virtual std::optional<AgeCounts> sum(const AgeCounts& mine) = 0;
};

/// The uncached pixels of a region, by this process alone. False: stopped.
[[nodiscard]] bool trace_alone(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
                               Executor& executor, const StopFlag& stop);

/// A process that draws all of the frame.
class NoFrameExchange final : public FrameExchange {
  public:
    [[nodiscard]] bool exchange_points(CloudRegion&, const StopFlag&) override { return true; }
    void send_used(const CloudRegion&) override {}
    [[nodiscard]] bool trace(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
                             Executor& executor, const StopFlag& stop) override {
        return trace_alone(region, tracer, sample, executor, stop);
    }
    void deliver(const FrameOrder&, CloudRegion&) override {}
    [[nodiscard]] std::optional<AgeCounts> sum(const AgeCounts& mine) override { return mine; }
};

/// Draws one part of each frame of a walk.
class FrameLoop {
  public:
    /// @param index, owners  which part of a frame this one owns, of how many
    explicit FrameLoop(const CloudOptions& options, std::size_t index = 0, std::size_t owners = 1,
                       FrameClock clock = {})
        : options_(options), index_(index), owners_(owners), clock_(std::move(clock)) {}

    /// The next frame. False: stopped; then, and when the caster throws, the cloud is as it was
    /// before. Throws InputError for orders that cannot be.
    [[nodiscard]] bool draw(const FrameOrder& order, const Camera& camera, PixelCaster& caster,
                            FrameExchange& exchange, Executor& executor, const StopFlag& stop);

    /// The next frame, which is one of a new view, does without points that may show these.
    void drop(const ShownMaterials& materials) {
        if (shown_.region) shown_.region->points().drop(materials);
        aside_.forget();
    }

    /// The part of the last frame that was not drawn aside (FrameOrder::aside); null before the
    /// first one.
    [[nodiscard]] const CloudRegion* region() const {
        return shown_.region ? &*shown_.region : nullptr;
    }
    /// The part of a frame that was just drawn.
    [[nodiscard]] CloudRegion& drawn(const FrameOrder& order) { return *of(order).region; }
    /// How long the last frame's points took to be kept [s].
    [[nodiscard]] double keep_seconds() const { return shown_.keep_seconds; }

  private:
    /// What is known from frame to frame.
    struct Frames {
        std::optional<CloudRegion> region;
        View view;                                   ///< of the last frame
        int width = 0, height = 0;                   ///< of the picture that the region is part of
        double infer_seconds = 0, keep_seconds = 0;  ///< of the last frame [s]
        double unknown = 1;                          ///< share of its pixels that no point answered
        void forget() {
            region.reset();
            infer_seconds = keep_seconds = 0;
            unknown = 1;
        }
    };
    [[nodiscard]] Frames& of(const FrameOrder& order) { return order.aside ? aside_ : shown_; }
    void begin(const FrameOrder& order, const Camera& camera, Executor& executor);
    void put_aside_to_sleep();
    void refine(CloudRegion& region, std::span<const PixelPlace> places) const;

    CloudOptions options_;
    std::size_t index_, owners_;
    FrameClock clock_;
    Frames shown_;
    Frames aside_;  ///< of one view; its points sleep among the others' as soon as it is left
};

}  // namespace lightwalk
