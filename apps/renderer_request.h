#pragma once
// From what command lines say to what a renderer is asked for.
#include "apps/common_options.h"
#include "apps/interrupt.h"
#include "apps/rank_backend.h"
#include "apps/render_command.h"
#include "apps/warnings.h"

namespace lightwalk {

/// Of the options that all commands share; renderers warn through `warnings`, and stop when an
/// interrupt is requested.
[[nodiscard]] RendererRequest renderer_request(const CommonOptions& common,
                                               const RenderSettings& settings,
                                               const std::string& history,
                                               StderrWarnings& warnings);
/// Of the command line of `lightwalk render`, `animate` or `walk`.
[[nodiscard]] RendererRequest renderer_request(const RenderCommand& command,
                                               StderrWarnings& warnings);
/// Of the scene alone.
[[nodiscard]] SceneSource scene_source(const CommonOptions& common);

}  // namespace lightwalk
