#pragma once
// A frame of a walk, or the part of it that one process owns: one function, for one process and for
// many.
#include <optional>
#include <span>

#include "core/cloud/primary_visibility.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_region.h"
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

/// A process that draws all of the frame.
class NoFrameExchange final : public FrameExchange {
  public:
    [[nodiscard]] bool exchange_points(CloudRegion&, const StopFlag&) override { return true; }
    void send_used(const CloudRegion&) override {}
    [[nodiscard]] bool trace(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
                             Executor& executor, const StopFlag& stop) override;
    void deliver(const FrameOrder&, CloudRegion&) override {}
    [[nodiscard]] std::optional<AgeCounts> sum(const AgeCounts& mine) override { return mine; }
};

/// Draws one part of each frame of a walk.
class FrameLoop {
  public:
    /// @param index, owners  which part of a frame this one owns, of how many
    explicit FrameLoop(const CloudOptions& options, std::size_t index = 0, std::size_t owners = 1)
        : options_(options), index_(index), owners_(owners) {}

    /// The next frame. False: stopped; then, and when the caster throws, the cloud is as it was
    /// before. Throws InputError for orders that cannot be.
    [[nodiscard]] bool draw(const FrameOrder& order, const Camera& camera, PixelCaster& caster,
                            FrameExchange& exchange, Executor& executor, const StopFlag& stop);

    /// The next frame, which is one of a new view, does without points that may show these.
    void drop(const ShownMaterials& materials) {
        if (region_) region_->points().drop(materials);
    }

    /// The part of the last frame; null before the first one.
    [[nodiscard]] CloudRegion* region() { return region_ ? &*region_ : nullptr; }
    [[nodiscard]] const CloudRegion* region() const { return region_ ? &*region_ : nullptr; }
    /// How long the last frame's points took to be kept [s].
    [[nodiscard]] double keep_seconds() const { return keep_seconds_; }

  private:
    void begin(const FrameOrder& order, const Camera& camera, Executor& executor);
    void refine(std::span<const PixelPlace> places);

    CloudOptions options_;
    std::size_t index_, owners_;
    std::optional<CloudRegion> region_;
    int width_ = 0, height_ = 0;                   ///< of the picture that the region is a part of
    double infer_seconds_ = 0, keep_seconds_ = 0;  ///< of the last frame [s]
    double unknown_ = 1;                           ///< share of its pixels that no point answered
};

}  // namespace lightwalk
