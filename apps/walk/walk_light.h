#pragma once
// What the frames of a walk through a scene are made of: its options, and its light without what
// takes long.
#include <memory>

#include "apps/render_command.h"
#include "apps/scene_session.h"
#include "parallel/frame_options.h"
#include "parallel/walk/cloud_frame.h"

namespace lightwalk {

[[nodiscard]] CloudOptions walk_cloud_options(const RenderCommand& command);
/// But for the size.
[[nodiscard]] FrameOptions walk_picture_options(const RenderCommand& command);

/// The tracer of a scene without indirect light; null: it has none anyway. The session must outlive
/// it.
[[nodiscard]] std::unique_ptr<const Tracer> without_indirect(const SceneSession& session,
                                                             WarningSink& warnings);

}  // namespace lightwalk
