#pragma once
// Pictures and the frames of a walk, put together from the parts that ranks have sent.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/math/task_runner.h"
#include "parallel/frame.h"
#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// Throws InputError for parts that do not make the picture.
[[nodiscard]] Frame assemble_picture(const FinishedPicture& picture, int width, int height);

/// A frame from its parts. In its report seconds are those of the slowest rank in each step; the
/// points are those that there is room for, of which a few less are kept where there was too little
/// (see age_limit). It says of no pixel why it was traced, and where pixels come from
/// only where the order asked for that.
struct AssembledFrame {
    CloudFrame frame;
    /// Values of the order's refined pixels, in its order.
    std::vector<std::optional<PixelValue>> refined;
    std::vector<Rgb> refined_groups;  ///< see TracedValues
};

/// Throws InputError for parts that do not make the frame that was ordered.
/// @param task_runner  unpacks the parts side by side
[[nodiscard]] AssembledFrame assemble_frame(const FrameOrder& order, const FinishedFrame& finished,
                                            const TaskRunner& task_runner = SerialTaskRunner());

}  // namespace lightwalk
