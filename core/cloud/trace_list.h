#pragma once
// The pixels of a frame that are to be traced, in order of need, and what tracing them gave.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/region_points.h"
#include "core/math/random.h"
#include "core/math/task_runner.h"

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

/// Pixels that were traced, while they are handed over.
struct TracedPixels {
    std::span<const TracedPixelResult> results;
    /// Where light groups are kept, what each adds to a pixel, and to the first one of its two
    /// points; by pixel, then group. Empty: they are not.
    std::span<const Rgb> groups = {}, ahead = {};
    operator std::span<const TracedPixelResult>() const { return results; }  // for who keeps none
};

/// The same mixture in a traced pixel's value and in its points. Where it is not known how much of
/// it is of a mirror's image and how much of what lies ahead, no points are left.
/// @param groups  of several pixels
/// @param pixel   which of them this is
/// @param ahead   place for what each group adds to the first of two points
void mix_pixel(const TracedPixel& traced, const PixelGroups& groups, std::size_t pixel,
               std::span<Rgb> ahead, TracedPixelResult& result);

/// Where time is short the worst cause comes first, among equals coarse grids; else all are alike.
[[nodiscard]] inline std::size_t trace_rank(const UncachedPixel& pixel, bool time_is_short) {
    if (!time_is_short) return 0;
    return static_cast<std::size_t>(pixel.cause) * kGridLevels +
           static_cast<std::size_t>(grid_level(pixel.place));
}
inline constexpr std::size_t kTraceRanks = kTraceCauses * kGridLevels;

/// What the points leave of a block.
struct BlockUncachedPixels {
    std::vector<UncachedPixel> uncached;
    std::array<std::uint32_t, kTraceRanks>
        ranked{};                ///< how many of each rank, then where the next one goes
    std::size_t left = 0;        ///< pixels of which nothing is known
    std::size_t unanswered = 0;  ///< pixels, noted or not
};

/// What decides whether a frame's audit traces a pixel though it is reused, and whether twice.
/// @param seed  CloudOptions::seed
[[nodiscard]] inline RandomStream audit_stream(std::uint64_t seed, std::uint64_t frame,
                                               const PixelPlace& place) {
    return RandomStream::of_pixel(seed + frame + 1, static_cast<std::uint32_t>(place.x),
                                  static_cast<std::uint32_t>(place.y), 0);
}

class TraceList {
  public:
    explicit TraceList(const CloudOptions& options) : options_(options) {}

    /// A new frame: nothing is to be traced.
    void begin();
    /// What the points have left of all blocks: ordered by rank, and by block, where time is short
    /// another one first in each frame. Chooses the noise pairs.
    void gather(std::span<BlockUncachedPixels> blocks, std::uint64_t frame,
                const TaskRunner& task_runner);
    /// Pixels of a view that rests, which were chosen elsewhere.
    void refine(std::span<const PixelPlace> places);

    [[nodiscard]] std::span<const UncachedPixel> pixels() const { return uncached_; }
    /// So many of the pixels are to be traced by a second ray, too, to tell how much two differ.
    [[nodiscard]] std::size_t noise_pairs() const { return noise_pairs_.size(); }
    /// What is to be traced: the pixels, then the noise pairs by their second rays.
    [[nodiscard]] std::vector<PixelPlace> places() const;
    /// Number of the pixels that no point answers, whether they are on the list or not.
    [[nodiscard]] std::size_t unanswered() const { return unanswered_; }
    /// The finest grid (grid_level) of those pixels of which nothing is known that this frame's
    /// blocks should note: so fine that a few times as many are as the last frame had time to
    /// trace.
    [[nodiscard]] int finest_grid() const { return finest_; }

    /// `first` ... of the places are traced, either pixels or noise pairs. Called by many threads
    /// at once, for different ones.
    /// @param groups, ahead  see TracedPixels
    void record(std::size_t first, std::span<const TracedPixelResult> traced,
                std::span<const Rgb> groups = {}, std::span<const Rgb> ahead = {});
    /// The values of the pixels, in their order; none: there was no time.
    [[nodiscard]] std::vector<std::optional<PixelValue>> values() const;
    [[nodiscard]] std::size_t light_groups() const { return options_.light_groups; }
    /// What each light group adds to them, by pixel, then group; empty: they are not kept.
    [[nodiscard]] std::span<const Rgb> groups() const {
        return std::span(groups_).first(uncached_.size() * options_.light_groups);
    }

    /// Put what was traced into the frame, and into its report. What was not, but is known all the
    /// same, is inferred.
    /// @param passing  whether the rays were others than those of the picture of a view that rests,
    ///                 for which the pixels are to be traced once more
    void show(CloudFrame& frame, bool passing);
    /// What was traced leaves its points.
    void leave_points(RegionPoints& points) const;

  private:
    void expect();
    void choose_noise_pairs(std::uint64_t frame);
    [[nodiscard]] int next_finest_grid() const;

    CloudOptions options_;
    std::vector<UncachedPixel> uncached_;
    std::vector<TracedPixelResult> traced_;   ///< each of them
    std::vector<std::uint8_t> done_;          ///< not 0 where one was traced in time
    std::vector<Rgb> groups_, ahead_;         ///< see TracedPixels
    std::vector<std::uint32_t> noise_pairs_;  ///< indices of them
    std::vector<Rgb> pair_radiance_;
    std::vector<std::uint8_t> pair_done_;
    std::size_t unanswered_ = 0;  ///< pixels that no point answers
    std::size_t left_ = 0;        ///< of these those of which nothing is known
    std::size_t answered_ = 0;    ///< of the unanswered those that were traced
    int finest_ = kGridLevels - 1;
};

}  // namespace lightwalk
