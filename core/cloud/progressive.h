#pragma once
// Progressive refinement of a view that stands still: which pixels to trace next.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/math/rgb.h"
#include "core/transport/light_groups.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Number of nested grids of pixels, each twice as fine as the preceding one; the coarsest has
/// every 16th pixel of every 16th row. Tracing grid by grid shows a rough picture early.
inline constexpr int kGridLevels = 5;
/// The coarsest grid that a pixel belongs to, 0 ... kGridLevels - 1.
[[nodiscard]] inline int grid_level(const PixelPlace& place) {
    const auto bits =
        static_cast<unsigned>(place.x) | static_cast<unsigned>(place.y) | 1U << (kGridLevels - 1);
    return kGridLevels - 1 - std::countr_zero(bits);
}

/// Where a pixel's value comes from.
struct PixelOrigin {
    enum class Kind : std::uint8_t {
        filled,   ///< interpolated from its neighbours
        guessed,  ///< from points that are not close enough to be reused
        reused,   ///< from points
        traced,
    };
    Kind kind = Kind::filled;
    std::uint8_t samples = 0;  ///< rays so far, for traced pixels
    std::uint32_t order = 0;  ///< for reused pixels: the lower, the longer ago the point was traced
};

/// Pixels that are to be traced with the same sample number, the most needed first.
struct ProgressiveWork {
    int sample = 0;
    std::vector<PixelPlace> places;
};

/// Values of pixels.
struct TracedValues {
    TracedValues(std::vector<std::optional<PixelValue>> its_values = {},
                 std::vector<Rgb> its_groups = {})
        : values(std::move(its_values)), groups(std::move(its_groups)) {}
    std::vector<std::optional<PixelValue>> values;  ///< none: there was no time
    /// What each light group adds to a pixel, by pixel, then group; empty: they are not kept.
    std::vector<Rgb> groups;
};

/// The picture of a view that stands still, with the origin of each pixel.
class ProgressivePicture {
  public:
    /// Default of the number of rays that a pixel at an edge finally gets.
    static constexpr int kMostSamples = 8;

    /// @param samples  1 ... 255: number of rays that a pixel at an edge finally gets
    ProgressivePicture(int width, int height, int samples = kMostSamples)
        : width_(width), height_(height), most_samples_(samples) {}

    /// Start to refine a new picture, given row by row.
    /// @param groups  what each light group adds to its pixels; empty: it is not known
    void begin(std::span<const Rgb> radiance, std::span<const float> distance,
               std::span<const PixelOrigin> origins, std::span<const Rgb> groups = {});

    /// The next pixels to trace, at most `most`: first interpolated ones (coarse grids first), then
    /// guessed ones, then reused ones (oldest points first), then further rays, one at a time, for
    /// pixels that differ by more than a tenth from a neighbour: those with the fewest rays first,
    /// unless they are few. Empty when the picture is finished. Which pixels get further rays does
    /// not depend on `most`, or on how many there is time for: so neither does a finished picture.
    [[nodiscard]] ProgressiveWork next(std::size_t most) const;
    /// Whether next() has nothing any more.
    [[nodiscard]] bool finished() const;
    /// Number of pixels that have not been traced.
    [[nodiscard]] std::size_t open_pixels() const;
    /// Number of pixels that are interpolated or guessed.
    [[nodiscard]] std::size_t guessed_pixels() const;
    /// The picture; its interpolated pixels are filled from all that is known by now.
    [[nodiscard]] std::vector<Rgb> picture() const;

    /// Record the values of the pixels of `work`; none: there was no time for it.
    /// @param groups  see TracedValues
    void record(const ProgressiveWork& work, std::span<const std::optional<PixelValue>> traced,
                std::span<const Rgb> groups = {});

    /// Whether it is known of all pixels what each light group adds to them.
    [[nodiscard]] bool knows_groups() const {
        return !groups_.empty() && with_groups_ >= radiance_.size();
    }
    /// Show another mixture of the light groups. Only where it knows_groups().
    void mix(const LightMixture& mixture);
    /// By pixel, then group.
    [[nodiscard]] std::span<const Rgb> groups() const { return groups_; }

    [[nodiscard]] std::span<const Rgb> radiance() const { return radiance_; }
    /// Along the pixels' first rays [m].
    [[nodiscard]] std::span<const float> distance() const { return distance_; }
    [[nodiscard]] std::span<const PixelOrigin> origins() const { return origins_; }

  private:
    [[nodiscard]] ProgressiveWork open(std::size_t most) const;
    [[nodiscard]] bool has_open() const;
    [[nodiscard]] ProgressiveWork steep() const;
    void choose_edges();
    [[nodiscard]] bool is_steep(int x, int y) const;
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_, height_, most_samples_;
    std::vector<Rgb> radiance_;
    std::vector<float> distance_;
    std::vector<PixelOrigin> origins_;
    ProgressiveWork edges_;    ///< pixels that were at edges when all of them were chosen at once
    std::vector<Rgb> groups_;  ///< by pixel, then group; empty: not kept
    std::size_t with_groups_ = 0;  ///< pixels of which these are known
};

}  // namespace lightwalk
