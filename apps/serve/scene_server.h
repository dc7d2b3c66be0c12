#pragma once
// A process that holds a compiled scene and answers rtrace's rays in it: lightwalk trace --serve.
#include <chrono>
#include <string>

#include "apps/session/lightwalk/scene.h"

namespace lightwalk {

/// Reads the scene and stands ready until nobody has asked for `idle`, a file of the scene changes,
/// or newer servers of the same user need the place. For each who asks it forks: what a run does
/// ends with it. Returns the exit status. Throws InputError for what cannot be served.
/// @param source  without its files
/// @param file    the octree, as whoever asks types it
int serve_scene(SceneSource source, const std::string& file, std::chrono::duration<double> idle);

}  // namespace lightwalk
