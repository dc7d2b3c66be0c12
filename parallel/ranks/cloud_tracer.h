#pragma once
// The threads of a rank that draw the frames of a walk with other ranks: its own part from the
// points that lie there, and whatever pixels the master gives it to trace.
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/cloud/primary_visibility.h"
#include "parallel/executor.h"
#include "parallel/ranks/message.h"
#include "parallel/ranks/roles.h"
#include "parallel/ranks/timeline.h"
#include "parallel/ranks/topology.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_region.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {

/// What a frame is seen by: its camera, and its rays (see PixelCaster).
class WalkRays {
  public:
    virtual ~WalkRays() = default;
    [[nodiscard]] virtual const Camera& camera() const = 0;
    virtual void probe(std::span<const PixelPlace> places, std::span<PixelVisibility> visibility,
                       int worker) = 0;
    virtual void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                       int sample, int worker) = 0;
    /// That were traced so far, of this frame and those before.
    [[nodiscard]] virtual std::uint64_t traced() const = 0;
};
/// Makes them of an order. Called once a frame on every rank that traces.
using MakeWalkRays = std::function<std::unique_ptr<WalkRays>(const CloudOrder&)>;

struct CloudTracerOptions {
    std::size_t index = 0;     ///< of this rank among those that trace
    std::vector<int> workers;  ///< all of these
    std::size_t owners = 1;    ///< the first of them, which own parts
    CloudOptions cloud;
    EncodePiece encode;
};

class CloudTracer {
  public:
    /// Sends a message of Role::tracer; called by many threads.
    using Post = std::function<void(Address to, Message message)>;

    /// @param timeline  gets what the threads do; null: nobody wants to know
    CloudTracer(CloudTracerOptions options, MakeWalkRays make, Post post,
                Timeline* timeline = nullptr)
        : options_(std::move(options)),
          make_(std::move(make)),
          post_(std::move(post)),
          timeline_(timeline) {}

    /// What CloudWorkerRole passes on, Finish: from any thread.
    void take(Message message);

    /// Draws with all workers of `executor` what is ordered, until the end is or `stop` is
    /// requested. Throws what the rays throw.
    void run(Executor& executor, const StopFlag& stop);

  private:
    /// One frame at work.
    struct Frame {
        const CloudOrder& order;
        const PixelCaster& caster;
        Executor& executor;
        const StopFlag& stop;
    };
    [[nodiscard]] std::optional<CloudOrder> next_order(const StopFlag& stop);
    [[nodiscard]] bool wait_for(CloudStage::Kind stage, const StopFlag& stop);
    [[nodiscard]] std::optional<GiveUncachedPixels> next_uncached(WalkFrameId frame, int worker,
                                                                  const StopFlag& stop);
    void draw(const CloudOrder& order, Executor& executor, const StopFlag& stop);
    [[nodiscard]] double begin(const CloudOrder& order, Executor& executor);
    [[nodiscard]] bool answer(const Frame& frame);
    void refine(const CloudOrder& order);
    void send_points(WalkFrameId frame);
    void send_used(WalkFrameId frame);
    void send_uncached(WalkFrameId frame);
    void serve(const Frame& frame, const UncachedPixelTracer& tracer);
    void trace(const GiveUncachedPixels& uncached, const UncachedPixelTracer& tracer, int sample,
               int worker);
    [[nodiscard]] bool finish(const Frame& frame, std::uint64_t rays);
    void take_traced();
    [[nodiscard]] CloudPart part_of(const CloudOrder& order);
    [[nodiscard]] std::string encoded();
    [[nodiscard]] Address worker(std::size_t index) const {
        return {options_.workers[index], Role::worker};
    }

    CloudTracerOptions options_;
    MakeWalkRays make_;
    Post post_;
    Timeline* timeline_;
    SubImages parts_;                    ///< of the frame at hand
    std::optional<CloudRegion> region_;  ///< the own part
    int width_ = 0, height_ = 0;         ///< of the picture that it is a part of
    double last_keep_seconds_ = 0;       ///< of the frame before

    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::deque<CloudOrder> orders_;
    std::deque<GiveUncachedPixels> uncached_;
    WalkFrameId frames_dealt_out_ = 0;  ///< of frames before this one no more uncached pixels come
    std::vector<CloudPoints> points_;
    std::vector<CloudUsed> used_;
    std::vector<TracedPixelResults> traced_;
    bool points_there_ = false, pixels_there_ = false;
    bool finished_ = false;
};

}  // namespace lightwalk
