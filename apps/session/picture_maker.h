#pragma once
// Who makes the pictures of a run: this process, or all ranks together.
#include <memory>
#include <optional>

#include "core/view/view.h"
#include "parallel/frame.h"
#include "parallel/frame_options.h"

namespace lightwalk {

/// A picture that is wanted, with all that its options refer to.
struct PictureRequest {
    /// @param before  the view of the frame before, for motion blur; null or unusable: none
    PictureRequest(const View& view, const View* before, const FrameOptions& wanted)
        : camera(view), options(wanted) {
        if (before != nullptr && !Camera::problem(*before)) previous.emplace(*before);
        options.previous = previous ? &*previous : nullptr;
    }
    PictureRequest(const PictureRequest&) = delete;
    PictureRequest& operator=(const PictureRequest&) = delete;

    Camera camera;
    std::optional<Camera> previous;
    FrameOptions options;
    std::shared_ptr<CheckpointSink> checkpoint;  ///< null: none
};

class PictureMaker {
  public:
    virtual ~PictureMaker() = default;
    /// A picture that take() will be asked for, after those ordered before it: work on it may
    /// begin.
    virtual void order(std::shared_ptr<const PictureRequest> request) = 0;
    /// The oldest picture that was ordered and not taken; nothing: interrupted.
    [[nodiscard]] virtual std::optional<Frame> take() = 0;
    /// So many pictures are worth ordering before the first is taken.
    [[nodiscard]] virtual std::size_t ahead() const = 0;
};

}  // namespace lightwalk
