#pragma once
// The owners of a frame's parts, over messages.
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "parallel/ranks/rank_link.h"
#include "parallel/sub_images.h"
#include "parallel/walk/frame_caster.h"
#include "parallel/walk/frame_loop.h"

namespace lightwalk {

/// What a rank draws frames of.
struct WalkScene {
    /// Makes the rays of an order. Called once a frame on every rank that traces.
    std::function<std::unique_ptr<FrameCaster>(const FrameOrder& order)> make_rays;

    // Of scenes that change:

    /// Makes another scene, beside the one at hand. What it throws says why it cannot be.
    std::function<void(const std::string& payload)> prepare = {};
    /// From now on rays are of the scene that was prepared: returns the number of light groups that
    /// are kept.
    std::function<std::size_t(FrameNumber number)> take = {};
    /// The scene that was prepared, if one was, is not wanted.
    std::function<void()> drop = {};
};

/// The frames that rank 0 orders, drawn by the threads of a rank: its own part from the points that
/// lie there, and whatever uncached pixels the queue gives it. Until the inbox is closed or `stop`
/// is requested.
void draw_frames(RankLink& link, const CloudOptions& cloud, const WalkScene& scene,
                 Executor& executor, const StopFlag& stop);

/// Owners whose points may answer pixels of one of them: those whose parts touch its own.
[[nodiscard]] std::vector<std::size_t> owners_beside(const SubImages& parts, std::size_t index,
                                                     int width, int height);

}  // namespace lightwalk
