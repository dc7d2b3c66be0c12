#pragma once
// Other modifiers and sources for the scene of a walk, under the frames that go on.
#include <functional>

#include "apps/session/render_backend.h"
#include "core/model/model_change.h"

namespace lightwalk {

/// What RenderLoopOptions::change and RenderLoopOptions::replace need.
/// @param backend  must outlive the result
[[nodiscard]] std::function<const SceneSession&(const ModelChange& change)> scene_changer(
    RenderBackend& backend);
[[nodiscard]] std::function<const SceneSession&(const std::shared_ptr<const CompiledScene>& scene)>
scene_replacer(RenderBackend& backend);

}  // namespace lightwalk
