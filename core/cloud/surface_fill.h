#pragma once
// Colours for pixels that a frame had no time to trace, from what it shows around them of the
// surfaces that their rays meet: edges are sharp at once, light is coarse for a moment.
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/primary_visibility.h"

namespace lightwalk {

/// What a pixel that was not traced shows.
struct InferredPixel {
    std::size_t at = 0;  ///< its index in the frame
    Rgb radiance;        ///< [W/(m² sr)]
    float distance = 0;  ///< along its ray, which was cast [m]
    bool same = false;   ///< from the surface that it shows, or one that is_kin(); else from others
                         ///< about as far away
};

/// What a pixel shows whose ray sees `visibility`: the mean of known pixels around, weighted by
/// their inverse squared distances (Shepard, "A two-dimensional interpolation function for
/// irregularly-spaced data", ACM 1968). Nothing where there is none of the same surface, and none
/// as far away, within 16 pixels.
[[nodiscard]] std::optional<InferredPixel> infer_pixel(const CloudFrame& frame,
                                                       const PixelPlace& place,
                                                       const PixelVisibility& visibility);

/// All pixels of a block that are not known. Blocks of a frame may be inferred at the same time,
/// each worker with its own number. The frame is read only.
void infer_block(const CloudFrame& frame, const PixelRectangle& block, PixelCaster& caster,
                 int worker, std::vector<InferredPixel>& found);

/// Put inferred pixels into the frame, and into its report.
void show_inferred(std::span<const InferredPixel> inferred, CloudFrame& frame);

}  // namespace lightwalk
