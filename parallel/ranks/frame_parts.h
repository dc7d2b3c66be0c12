#pragma once
// The parts of a walk's frame that ranks have drawn, put together.
#include <cstdint>
#include <optional>
#include <vector>

#include "parallel/walk/cloud_frame.h"
#include "parallel/walk/frame_order.h"

namespace lightwalk {

/// A frame from its parts. In its report seconds are those of the slowest rank in each step; the
/// points are those that there is room for, of which a few less are kept where there was too little
/// (see age_limit). It says of no pixel why it was traced.
struct AssembledFrame {
    CloudFrame frame;
    std::vector<std::uint8_t> known;   ///< for each pixel: not 0 where something is known of it
    std::vector<PixelOrigin> origins;  ///< where the order asked for them
    /// Values of the order's refined pixels, in its order.
    std::vector<std::optional<PixelValue>> refined;
};

/// @param most_points  that there is room for
/// Throws InputError for parts that do not make the frame that was ordered.
[[nodiscard]] AssembledFrame assemble_frame(const FrameOrder& order, const FinishedFrame& finished,
                                            std::size_t most_points);

}  // namespace lightwalk
