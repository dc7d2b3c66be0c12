#pragma once
// Traces arbitrary pixels of a picture in packets.
#include <cstddef>
#include <span>
#include <vector>

#include "core/trace/tracer.h"
#include "core/transport/light_groups.h"
#include "core/view/pixel_rays.h"
#include "core/view/pixels.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

/// Finds the nearest hits of a packet of rays together, then shades them. For one worker. The
/// result of a pixel is independent of the other pixels of its packet.
class PixelTracer {
  public:
    /// All must outlive this; the context is used while pixels are traced.
    PixelTracer(const Tracer& tracer, const PixelRays& rays, TraceContext& context,
                const StopFlag& stop)
        : tracer_(tracer), pixel_rays_(rays), context_(context), stop_(stop) {}

    /// Set values[i], and hits[i] unless `hits` is empty, for places[i]. Pixels outside the view's
    /// domain are black at distance 0 and hit nothing; likewise those that a requested stop leaves
    /// undone. With several samples a pixel: their mean radiance, to which those outside the domain
    /// add black; distance and hit are the first sample's, which is nearest to the pixel's centre,
    /// but for the mirrored radiance, which is the mean.
    void operator()(std::span<const PixelPlace> places, std::span<PixelValue> values,
                    std::span<PixelHit> hits = {});

    /// One sample of each pixel alone: radiance, distance and hit as above, of this sample.
    void trace_one(int sample, std::span<const PixelPlace> places, std::span<PixelValue> values,
                   std::span<PixelHit> hits);

    /// Of pixel i of the last call, what each light group adds; empty: not asked for.
    [[nodiscard]] std::span<const Rgb> groups(std::size_t i) const {
        const std::size_t count = groups_.empty() ? 0 : context_.groups->size();
        return std::span(groups_).subspan(i * count, count);
    }

    /// The same of what comes by mirror-like reflection (PixelHit::mirrored); zeros where it is not
    /// known what each adds to that.
    [[nodiscard]] std::span<const Rgb> mirrored_groups(std::size_t i) const {
        const std::size_t count = groups_.empty() ? 0 : context_.groups->size();
        return std::span(mirrored_groups_).subspan(i * count, count);
    }

  private:
    void clear_groups(std::size_t places);
    void shade_by_groups();
    void trace_sample(int sample, std::span<const PixelPlace> places, std::span<PixelValue> values,
                      std::span<PixelHit> hits);

    const Tracer& tracer_;
    const PixelRays& pixel_rays_;
    TraceContext& context_;
    const StopFlag& stop_;
    std::vector<Ray> rays_;
    std::vector<RaySegment> segments_;
    std::vector<Hit> hits_;
    std::vector<std::size_t> targets_;  ///< indices into places
    std::vector<Rgb> groups_;           ///< by place, then light group
    std::vector<Rgb> mirrored_groups_;  ///< the same
    std::vector<PixelValue> more_;      ///< values of one further sample
    std::vector<PixelHit> more_hits_;
};

}  // namespace lightwalk
