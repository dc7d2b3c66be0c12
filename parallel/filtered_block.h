#pragma once
// The pixels of a block where neighbouring pixels share their samples.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/view/pixel_rays.h"
#include "core/view/pixels.h"
#include "parallel/frame_options.h"
#include "parallel/pixel_tracer.h"

namespace lightwalk {

struct BlockPixels;

/// Weighs the samples in and around a block by the filters of its pixels (pixel_filter() of
/// core/view). A pixel is the sum of weighted samples over that of the weights; samples outside the
/// view's domain are black. It reaches the pixels around it, as many on each side as its filter
/// says (reached_pixels()): of each of these the samples are summed in their order, then these sums
/// in order of the places, so that the bits do not depend on blocks. The samples around the block
/// are traced again by those beside it, which takes less than to send them there would take in
/// code. Where weights are negative so may sums be: these pixels are 0, each channel and layer by
/// itself. Not those of tiles (FrameOptions::tiles), which are for a mean of several pictures.
class FilteredBlock {
  public:
    /// @param groups  how many light groups each pixel keeps
    /// The rays and the options must outlive this.
    FilteredBlock(const PixelRays& rays, const FrameOptions& options, const PixelRectangle& block,
                  std::size_t groups);

    /// The block and the pixels on each side that its filters reach, some outside the picture.
    [[nodiscard]] const PixelRectangle& around() const { return around_; }

    /// Trace one sample of each pixel of `packet`, which lies in around(), but for those that no
    /// pixel of the block reaches. All of a pixel's samples have to be traced in their order.
    /// Distances and hits of `pixels` are set to those of the sample of their own that is nearest
    /// to the centre.
    void trace(PixelTracer& trace, const PixelRectangle& packet, int sample, BlockPixels& pixels);

    /// When all are traced: set radiance, mirrored radiance of hits, and groups.
    void gather(BlockPixels& pixels) const;

  private:
    static constexpr int kFarthest = 2;  ///< of the pixels that any filter reaches
    struct Sample {
        PixelPlace place;
        PixelOffset offset;
    };
    /// Pixels that a sample may count for.
    [[nodiscard]] std::size_t reached() const {
        const auto side = static_cast<std::size_t>(side_);
        return side * side;
    }
    [[nodiscard]] Sample sample_at(const PixelPlace& place, int sample) const;
    [[nodiscard]] bool counts(const Sample& sample) const;
    /// Whether a pixel that is wanted lies within `reach` of a place [pixels].
    [[nodiscard]] bool reaches(double x, double y, double reach) const;
    void keep_nearest(const Sample& sample, const PixelValue& value, const PixelHit* hit,
                      BlockPixels& pixels);
    void add(const Sample& sample);
    void sum_up(const PixelPlace& place, std::span<Rgb> sums) const;

    const PixelRays& rays_;
    const FrameOptions& options_;
    PixelFilter filter_;
    double reach_;  ///< of the filter [pixels]
    int farthest_;  ///< the same in whole pixels
    int side_;      ///< of the square of pixels that a sample may count for
    PixelRectangle block_, around_;
    std::size_t groups_;
    std::size_t layers_;             ///< radiance, with hits mirrored radiance, groups
    std::vector<float> weights_;     ///< by pixel of around_, then pixel that is reached
    std::vector<Rgb> sums_;          ///< by pixel, then pixel that is reached, then layer
    std::vector<double> nearest_;    ///< by pixel of the block: squared distance [pixels²]
    std::vector<Rgb> layer_values_;  ///< of the sample that is added
    std::vector<PixelPlace> places_;
    std::vector<Sample> samples_;
    std::vector<PixelValue> values_;
    std::vector<PixelHit> hits_;
};

}  // namespace lightwalk
