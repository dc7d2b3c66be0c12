#pragma once
// One run of rtrace in a process that a server has forked for it.
#include "apps/serve/served_words.h"
#include "apps/session/resident_scene.h"

namespace lightwalk {

/// Takes the request that comes by the socket and does what it asks for, as the program would that
/// sent it: its streams, folder, environment, signals, priority and processors. Ends the process;
/// what cannot be done as that program would do it is declined.
/// @param socket  connected to a program of the same user
/// @param key     of the scene
[[noreturn]] void serve_run(int socket, const SceneKey& key,
                            const std::shared_ptr<const ResidentScene>& scene);

}  // namespace lightwalk
