#pragma once
// A view that stands still: which pixels to trace next, so that its picture becomes ever better.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rgb.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Grids of pixels, each twice as fine as the one before: the coarsest has every 16th pixel of
/// every 16th row. What is traced grid by grid looks like the picture early.
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
        filled,   ///< from its neighbours
        guessed,  ///< from points that are not near enough
        reused,   ///< from points
        traced,
    };
    Kind kind = Kind::filled;
    std::uint8_t samples = 0;  ///< traced: rays so far
    std::uint32_t order = 0;   ///< reused: the lower, the longer ago the point was traced
};

/// Pixels that are to be traced with the same sample number, the most needed first.
struct ProgressiveWork {
    int sample = 0;
    std::vector<PixelPlace> places;
};

/// The picture of a progressive view, and how good each of its pixels is.
class ProgressivePicture {
  public:
    /// Rays that a pixel at an edge gets in the end, unless told otherwise.
    static constexpr int kMostSamples = 8;

    /// @param samples  1 ... 255: rays that a pixel at an edge gets in the end
    ProgressivePicture(int width, int height, int samples = kMostSamples)
        : width_(width), height_(height), most_samples_(samples) {}

    /// A new picture to work on, row by row.
    void begin(std::span<const Rgb> radiance, std::span<const PixelOrigin> origins);

    /// At most so many pixels: those filled from others, coarse grids first, guessed ones, then
    /// reused ones, oldest points first, then, one ray more a pixel each time, those that differ by
    /// more than a tenth from a neighbour. Nothing when the picture is as good as it gets.
    [[nodiscard]] ProgressiveWork next(std::size_t most) const;
    /// Pixels that have not been traced.
    [[nodiscard]] std::size_t open_pixels() const;
    /// Pixels that show neither what was traced nor what points tell truthfully.
    [[nodiscard]] std::size_t guessed_pixels() const;
    /// The picture, its filled pixels from what is known by now.
    [[nodiscard]] std::vector<Rgb> picture() const;

    /// The first pixels of `work` were traced: the others were not.
    void record(const ProgressiveWork& work, std::span<const Rgb> traced);

    [[nodiscard]] std::span<const Rgb> radiance() const { return radiance_; }
    [[nodiscard]] std::span<const PixelOrigin> origins() const { return origins_; }

  private:
    [[nodiscard]] ProgressiveWork open(std::size_t most) const;
    [[nodiscard]] ProgressiveWork steep(std::size_t most) const;
    [[nodiscard]] bool is_steep(int x, int y) const;
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_, height_, most_samples_;
    std::vector<Rgb> radiance_;
    std::vector<PixelOrigin> origins_;
};

}  // namespace lightwalk
