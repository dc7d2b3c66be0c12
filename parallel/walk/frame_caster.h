#pragma once
// The rays of one frame, whoever casts them.
#include <cstdint>

#include "core/cloud/primary_visibility.h"
#include "core/view/view.h"

namespace lightwalk {

class FrameCaster : public PixelCaster {
  public:
    [[nodiscard]] virtual const Camera& camera() const = 0;
    /// Rays that were traced so far, for this frame and those before.
    [[nodiscard]] virtual std::uint64_t traced() const = 0;
};

}  // namespace lightwalk
