#pragma once
// What the page is told of the sun's time.
#include <optional>
#include <string>

#include "io/net/walk_reply.h"
#include "io/scene/sky_calls.h"

namespace lightwalk {

/// The time of a scene's files, and why it cannot be changed; nothing where no generator has
/// written a sky.
[[nodiscard]] std::optional<TimePlace> time_place(const SkyCalls& skies);

/// @param time     that is shown; nothing: that of the files
/// @param problem  why it is not the one that was asked for; "": it is
[[nodiscard]] TimeReply time_reply(const SkyCalls& skies, const std::optional<SkyTime>& time,
                                   const std::string& problem);

}  // namespace lightwalk
