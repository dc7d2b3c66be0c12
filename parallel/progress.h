#pragma once
// Progress of work.
#include <cstdint>

#include "core/math/function_ref.h"

namespace lightwalk {

/// Progress of a frame or a prepass since it began.
struct FrameProgress {
    double done = 0;                   ///< share of the pixels, 0 ... 1
    std::uint64_t rays = 0;            ///< traced so far
    std::uint64_t ambient_values = 0;  ///< computed so far
};

using TakeProgress = FunctionRef<void(const FrameProgress& progress)>;

}  // namespace lightwalk
