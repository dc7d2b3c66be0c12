#pragma once
// The owners of a frame's parts, over messages.
#include <cstddef>
#include <memory>
#include <vector>

#include "core/view/view.h"
#include "parallel/ranks/rank_loop.h"
#include "parallel/ranks/trace_work.h"
#include "parallel/sub_images.h"
#include "parallel/walk/frame_loop.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {

/// Makes the rays of an order. Called once a frame on every rank that traces.
using MakeWalkRays = std::function<std::unique_ptr<SceneCaster>(const FrameOrder&)>;

struct WalkPartOptions {
    std::vector<int> workers;  ///< ranks that trace
    std::size_t index = 0;     ///< of this rank among them
    std::size_t owners = 1;    ///< the first of them, which own parts of the frames
    CloudOptions cloud;
    EncodePiece encode;
};

/// The frames that rank 0 orders, drawn by the threads of a rank: its own part from the points that
/// lie there, and whatever uncached pixels the queue gives it. Until the inbox is closed or `stop`
/// is requested.
/// @param timeline  gets what the threads do; null: nobody wants to know
void draw_frames(RankLoop& loop, TracerInbox& inbox, const WalkPartOptions& options,
                 const MakeWalkRays& make, Executor& executor, const StopFlag& stop,
                 Timeline* timeline = nullptr);

/// Owners whose points may answer pixels of one of them: those whose parts touch its own.
[[nodiscard]] std::vector<std::size_t> owners_beside(const SubImages& parts, std::size_t index,
                                                     int width, int height);

}  // namespace lightwalk
