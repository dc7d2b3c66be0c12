#pragma once
// The files that a page of a walk saves.
#include <optional>
#include <string>
#include <vector>

#include "apps/walk/material_edits.h"
#include "core/model/primitive.h"
#include "core/transport/light_groups.h"
#include "core/view/view.h"
#include "io/net/walk_request.h"
#include "io/net/web_server.h"
#include "io/scene/sky_calls.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// A picture as Radiance has it, with its view and how it came about in its header.
/// @param history  the command line
[[nodiscard]] WebAnswer saved_picture(const LivePicture& shown, const View& view,
                                      const Model& model, const std::string& history);

/// The modifiers of emitters as they are dimmed; 404 where none may be.
/// @param modifiers  the scene's own
/// @param groups     null: nothing may be dimmed
[[nodiscard]] WebAnswer saved_lights(const std::vector<Primitive>& modifiers,
                                     const LightGroups* groups, const LightsRequest& lights);

/// The modifiers that have other numbers than when the scene was read.
[[nodiscard]] WebAnswer saved_materials(const Model& built, const std::vector<ModifierEdit>& edits);

/// What the generators write for a time; 404 where none writes the sky.
/// @param time  nothing: that of the scene's files
[[nodiscard]] WebAnswer saved_sky(const SkyCalls& skies, const std::optional<SkyTime>& time);

}  // namespace lightwalk
