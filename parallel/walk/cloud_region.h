#pragma once
// A rectangle of a picture, and the points that lie in it: the steps of a frame of a walk. One
// process has one that is the whole picture; of many each has its own, and they give each other the
// points that leave one for another.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/primary_visibility.h"
#include "core/cloud/progressive.h"
#include "core/math/random.h"
#include "core/view/pixels.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/cloud_frame.h"

namespace lightwalk {

/// A pixel that is to be traced.
struct UncachedPixel {
    PixelPlace place;
    TraceCause cause = TraceCause::uncovered;
};

/// A pixel that was traced: what it shows, and the points that it leaves.
struct TracedPixelResult {
    PixelValue value;
    PixelPoints points;
};

/// Pixels whose points were used.
struct UsedPixels {
    std::vector<PixelPlace> ahead, mirrored;  ///< by the grid that the points are in (CloudGrids)
};

/// A rectangle with `by` more pixels on each side, inside a picture; empty where it is.
[[nodiscard]] PixelRectangle widened(const PixelRectangle& area, int by, int width, int height);

/// The steps of a frame, in this order: begin, project, [leaving, add,] answer, [used_beside,
/// mark_used,] record for each traced uncached pixel, show, age, keep. Those in brackets are for
/// regions that have others beside them. What comes of it depends on no order: neither of points
/// nor of calls of add, mark_used and record.
class CloudRegion {
  public:
    /// @param area  of a picture of width x height pixels
    CloudRegion(const PixelRectangle& area, int width, int height, const CloudOptions& options);

    /// A new frame. The camera must outlive it.
    void begin(const Camera& camera, const CloudRules& rules);

    /// Find the places of all points.
    void project(Executor& executor);
    /// Points that the picture shows outside the region, or at its edge: others need them. Calls
    /// take(point, pixel).
    template <class Take>
    void leaving(Take take) const {
        const PixelRectangle inner = inside_of_area();
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!(places_[i].distance > 0)) continue;
            const PixelPlace place = pixel_of(places_[i], width_, height_);
            if (!inner.contains(place)) take(points_[i], place);
        }
    }
    /// Points of other regions that lie in this one, or a pixel beside it.
    void add(std::span<const CloudPoint> points);

    using Clock = std::chrono::steady_clock;
    /// Find points for all pixels. What none answers is an uncached pixel. The caster's `probe` is
    /// called.
    /// @param check_until  with CloudCheck::rotating: after that no more rays check what points say
    void answer(const PixelCaster& caster, Executor& executor, const StopFlag& stop,
                Clock::time_point check_until = Clock::time_point::max());
    [[nodiscard]] std::span<const UncachedPixel> uncached() const { return uncached_; }
    /// Share of the pixels that no point answers, whether they are among the uncached pixels or
    /// not.
    [[nodiscard]] double unknown() const {
        return static_cast<double>(unanswered_) / static_cast<double>(area_.pixels());
    }
    /// Of the uncached pixels those that are to be traced by a second ray, too, to tell how much
    /// two differ.
    [[nodiscard]] std::span<const std::uint32_t> noise_pairs() const { return noise_pairs_; }
    /// Pixels beside the region whose points answered pixels of it.
    [[nodiscard]] UsedPixels used_beside() const;
    /// What others' used_beside() says of this one.
    void mark_used(const UsedPixels& used);

    /// Uncached pixels `first` ... are traced. Called by many threads at once, for different ones.
    void record(std::size_t first, std::span<const TracedPixelResult> traced);
    /// The noise pairs `first` ... are traced.
    void record_noise_pairs(std::size_t first, std::span<const TracedPixelResult> traced);
    [[nodiscard]] bool is_traced(std::size_t uncached_pixel) const {
        return done_[uncached_pixel] != 0;
    }

    /// Put what was traced into the frame.
    void show();
    /// For each pixel: not 0 where it shows something that is better than what its neighbours tell.
    [[nodiscard]] std::span<const std::uint8_t> known() const { return known_; }

    /// Points grow older; what was traced leaves new ones. All that are kept, by age.
    [[nodiscard]] AgeCounts age(Executor& executor);
    /// The points of the next frame.
    void keep(const AgeLimit& room, Executor& executor);

    [[nodiscard]] const PixelRectangle& area() const { return area_; }
    [[nodiscard]] CloudFrame& frame() { return frame_; }
    [[nodiscard]] std::span<const PixelOrigin> origins() const { return origins_; }
    [[nodiscard]] std::span<const CloudPoint> points() const { return points_; }
    [[nodiscard]] std::size_t pixel(const PixelPlace& place) const {
        return static_cast<std::size_t>(place.y - area_.y0) *
                   static_cast<std::size_t>(area_.width()) +
               static_cast<std::size_t>(place.x - area_.x0);
    }

    // A view that rests is not projected; instead of `answer` others say what is to be traced, and
    // instead of `age` points stay as they are.
    void refine(std::span<const PixelPlace> places);
    [[nodiscard]] TracedPixelResult& traced(std::size_t uncached_pixel) {
        return traced_[uncached_pixel];
    }
    /// @param leave  whether what was traced leaves points
    [[nodiscard]] AgeCounts rest(bool leave);

  private:
    [[nodiscard]] PixelRectangle inside_of_area() const;
    static constexpr std::size_t kTraceRanks = kTraceCauses * kGridLevels;
    /// Of a block.
    struct BlockUncachedPixels {
        std::vector<UncachedPixel> uncached;
        std::array<std::uint32_t, kTraceRanks>
            ranked{};                ///< how many, then where the next one goes
        std::size_t left = 0;        ///< pixels of which nothing is known
        std::size_t unanswered = 0;  ///< pixels, noted or not
    };
    void blacken(const PixelRectangle& area);
    void answer_block(std::size_t block, const PixelCaster& caster, int worker);
    void answer_packet(std::span<const PixelPlace> places, const PointFinder& finder,
                       const PixelCaster& caster, int worker, BlockUncachedPixels& block);
    [[nodiscard]] std::size_t answer_freely(std::span<PixelPlace> tile, const PointFinder& finder,
                                            BlockUncachedPixels& block);
    [[nodiscard]] std::span<PixelPlace> with_rays(std::span<PixelPlace> tile) const;
    void forget(std::span<const PixelPlace> tile);
    void leave(const PixelPlace& place, BlockUncachedPixels& block) const;
    [[nodiscard]] std::size_t leave_blank(std::span<PixelPlace> tile, const PixelSquare& square,
                                          BlockUncachedPixels& block);
    [[nodiscard]] int finest_grid() const;
    [[nodiscard]] std::size_t answer_temporal(std::span<PixelPlace> tile, const PixelSquare& square,
                                              const PointFinder& finder,
                                              BlockUncachedPixels& block);
    void answer_late(std::span<const PixelPlace> tile, const PixelSquare& square,
                     const PointFinder& finder, BlockUncachedPixels& block);
    [[nodiscard]] bool is_checked(const PixelPlace& place) const;
    void expect(const PixelPlace& place, const PointFinder& finder) const;
    void accept(const PixelPlace& place, const PointFinder& finder, const PixelAnswer& answer,
                BlockUncachedPixels& block);
    void accept_or_audit(const PixelPlace& place, const PointFinder& finder,
                         const PixelAnswer& answer, BlockUncachedPixels& block);
    [[nodiscard]] std::size_t rank(const UncachedPixel& uncached_pixel) const;
    void order_uncached(Executor& executor);
    void choose_noise_pairs();
    void expect_uncached();
    void leave_points();
    [[nodiscard]] RandomStream audit_stream(const PixelPlace& place) const;

    PixelRectangle area_;
    int width_, height_;
    CloudOptions options_;
    CloudGrids grids_;
    std::vector<CloudPoint> points_;
    std::vector<ImagePlace> places_;         ///< of the points in this frame
    std::vector<std::uint8_t> used_, kept_;  ///< by point
    std::vector<CloudPoint> fresh_;          ///< that this frame leaves

    // This frame.
    CloudRules rules_;
    ReuseRules reuse_;
    std::optional<PointProjector> projector_;
    CloudFrame frame_;
    std::vector<PixelOrigin> origins_;  ///< of each pixel; empty unless views that rest are refined
    Clock::time_point check_until_;
    std::vector<PixelRectangle> blocks_;
    std::vector<BlockUncachedPixels> uncached_of_;  ///< each block
    std::vector<std::uint8_t> known_;               ///< see known()
    std::size_t unanswered_ = 0;                    ///< pixels that no point answers
    std::size_t left_ = 0;                          ///< of these those of which nothing is known
    std::size_t answered_ = 0;                      ///< of the unanswered those that were traced
    int finest_ =
        kGridLevels - 1;  ///< of uncached pixels of which nothing is known (see grid_level)
    std::vector<UncachedPixel> uncached_;
    std::vector<TracedPixelResult> traced_;  ///< each uncached pixel
    std::vector<std::uint8_t>
        done_;  ///< for each uncached pixel: not 0 where it was traced in time
    std::vector<std::uint32_t> noise_pairs_;  ///< uncached pixels
    std::vector<Rgb> pair_radiance_;
    std::vector<std::uint8_t> pair_done_;
};

}  // namespace lightwalk
