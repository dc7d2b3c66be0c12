#pragma once
// A rectangle of a picture, and the points that lie in it: the steps of a frame of a walk, shared
// out to threads. One process has one that is the whole picture; of many each has its own, and they
// give each other the points that leave one for another.
#include <chrono>
#include <span>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/primary_visibility.h"
#include "core/cloud/region_points.h"
#include "core/cloud/trace_list.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/frame_clock.h"

namespace lightwalk {

/// The steps of a frame, in this order: begin, project, [points().leaving, add,] answer,
/// [used_beside and mark_used of the points,] record for each traced pixel of to_trace(), show,
/// infer, age, keep. Those in brackets are for regions that have others beside them. Of a view that
/// rests, which is not projected, others say what is to be traced: begin, refine, record, rest,
/// keep.
class CloudRegion {
  public:
    /// @param area  of a picture of width x height pixels
    CloudRegion(const PixelRectangle& area, int width, int height, const CloudOptions& options,
                FrameClock clock = {});

    /// A new frame. The camera must outlive it.
    void begin(const Camera& camera, const CloudRules& rules);
    /// Find the places of all points.
    void project(Executor& executor);
    /// Points of other regions that lie in this one, or a pixel beside it.
    /// @param groups  what light groups add, by point, then group; empty: not kept
    void add(std::span<const CloudPoint> points, std::span<const Rgb> groups);

    using Clock = std::chrono::steady_clock;
    /// Find points for all pixels. What none answers is to be traced. The caster's `probe` is
    /// called.
    /// @param check_until  with CloudCheck::rotating: after that no more rays check what points say
    void answer(PixelCaster& caster, Executor& executor, const StopFlag& stop,
                Clock::time_point check_until = Clock::time_point::max());
    /// Share of the pixels that no point answers, whether they are to be traced or not.
    [[nodiscard]] double unknown() const {
        return static_cast<double>(to_trace_.unanswered()) /
               static_cast<double>(frame_.area.pixels());
    }
    /// The view rests: trace these of its pixels.
    void refine(std::span<const PixelPlace> places);

    /// The view rests: pixels leave points that are known from elsewhere, where one place of a
    /// surface shows all of their light.
    /// @param known  see FrameOrder
    void recall(std::span<const PixelValue> known, PixelCaster& caster, Executor& executor);

    /// Put what was traced into the frame; see TraceList.
    void show(bool passing) { to_trace_.show(frame_, passing); }
    /// What is not known yet gets the colours of the same surfaces around, as far as there is time.
    /// The caster's `probe` is called.
    void infer(PixelCaster& caster, Executor& executor, const StopFlag& stop,
               Clock::time_point until);
    /// Points grow older; what was traced leaves new ones. All that are kept, by age.
    [[nodiscard]] AgeCounts age(Executor& executor);
    /// The same where the view rests.
    /// @param leave  whether what was traced leaves points
    [[nodiscard]] AgeCounts rest(bool leave);
    /// The points of the next frame.
    void keep(const AgeLimit& room, Executor& executor);

    [[nodiscard]] RegionPoints& points() { return points_; }
    [[nodiscard]] const RegionPoints& points() const { return points_; }
    [[nodiscard]] TraceList& to_trace() { return to_trace_; }
    [[nodiscard]] CloudFrame& frame() { return frame_; }
    [[nodiscard]] const CloudFrame& frame() const { return frame_; }

  private:
    CloudOptions options_;
    FrameClock clock_;
    CloudRules rules_;  ///< of this frame
    RegionPoints points_;
    CloudFrame frame_;
    std::vector<PixelRectangle> blocks_;
    std::vector<BlockUncachedPixels> uncached_of_;  ///< each block
    TraceList to_trace_;
};

}  // namespace lightwalk
