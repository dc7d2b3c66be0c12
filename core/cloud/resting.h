#pragma once
// A view that stands still: which pixels to trace next, so that its picture becomes ever better.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rgb.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Where a pixel's value comes from.
struct PixelOrigin {
    enum class Kind : std::uint8_t {
        filled,  ///< from its neighbours
        reused,  ///< from points
        traced,
    };
    Kind kind = Kind::filled;
    std::uint8_t samples = 0;  ///< traced: rays so far
    std::uint32_t order = 0;   ///< reused: the lower, the longer ago the point was traced
};

/// Pixels that are to be traced with the same sample number, the most needed first.
struct RestingWork {
    int sample = 0;
    std::vector<PixelPlace> places;
};

/// The picture of a resting view, and how good each of its pixels is.
class RestingPicture {
  public:
    /// Rays that a pixel at an edge gets in the end.
    static constexpr int kMostSamples = 8;

    RestingPicture(int width, int height) : width_(width), height_(height) {}

    /// A new picture to work on, row by row.
    void begin(std::span<const Rgb> radiance, std::span<const PixelOrigin> origins);

    /// At most so many pixels: those filled from others, then reused ones, oldest points first,
    /// then, one ray more a pixel each time, those that differ by more than a tenth from a
    /// neighbour. Nothing when the picture is as good as it gets.
    [[nodiscard]] RestingWork next(std::size_t most) const;

    /// The first pixels of `work` were traced: the others were not.
    void take(const RestingWork& work, std::span<const Rgb> traced);

    [[nodiscard]] std::span<const Rgb> radiance() const { return radiance_; }
    [[nodiscard]] std::span<const PixelOrigin> origins() const { return origins_; }

  private:
    [[nodiscard]] RestingWork open(std::size_t most) const;
    [[nodiscard]] RestingWork steep(std::size_t most) const;
    [[nodiscard]] bool is_steep(int x, int y) const;
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_, height_;
    std::vector<Rgb> radiance_;
    std::vector<PixelOrigin> origins_;
};

}  // namespace lightwalk
