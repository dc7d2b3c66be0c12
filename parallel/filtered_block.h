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
/// view's domain are black. It reaches its eight neighbours: of each of these nine the samples are
/// summed in their order, then these sums in order of the places, so that the bits do not depend on
/// blocks. The samples around the block are traced again by those beside it, which takes less than
/// to send them there would take in code.
class FilteredBlock {
  public:
    /// @param groups  how many light groups each pixel keeps
    /// The rays and the options must outlive this.
    FilteredBlock(const PixelRays& rays, const FrameOptions& options, const PixelRectangle& block,
                  std::size_t groups);

    /// The block and a pixel on each side, some of them outside the picture.
    [[nodiscard]] const PixelRectangle& around() const { return around_; }

    /// Trace one sample of each pixel of `packet`, which lies in around(), but for those that no
    /// pixel of the block reaches. All of a pixel's samples have to be traced in their order.
    /// Distances and hits of `pixels` are set to those of the sample of their own that is nearest
    /// to the centre.
    void trace(PixelTracer& trace, const PixelRectangle& packet, int sample, BlockPixels& pixels);

    /// When all are traced: set radiance, mirrored radiance of hits, and groups.
    void gather(BlockPixels& pixels) const;

  private:
    static constexpr std::size_t kReached = 9;  ///< pixels that a sample counts for, at most
    struct Sample {
        PixelPlace place;
        PixelOffset offset;
    };
    [[nodiscard]] Sample sample_at(const PixelPlace& place, int sample) const;
    [[nodiscard]] bool counts(const Sample& sample) const;
    /// Whether a pixel that is wanted lies within `reach` of a place [pixels].
    [[nodiscard]] bool reaches(double x, double y, double reach) const;
    void keep_nearest(const Sample& sample, const PixelValue& value, const PixelHit* hit,
                      BlockPixels& pixels);
    void add(const Sample& sample);

    const PixelRays& rays_;
    const FrameOptions& options_;
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
