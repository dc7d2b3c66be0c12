#pragma once
// What a run took, for --stats.
#include <cstddef>
#include <map>
#include <string>

#include "apps/session/compiled_scene.h"
#include "apps/session/walk_report.h"
#include "core/trace/tracer.h"

namespace lightwalk {

class SceneSession;

struct RunStatistics {
    std::string command;
    SceneCost scene;
    double render_seconds = 0;
    RayCounters rays;
    AmbientCounters ambient;
    std::size_t ambient_values = 0, ambient_bytes = 0;  ///< in the cache at the end
    int threads = 1;
    int width = 0, height = 0;  ///< of a picture; 0: no picture
    int frames = 0;
    int ranks = 1;
    WalkReport walk;                     ///< frames that reused others' points
    std::map<int, std::string> reports;  ///< of each rank (see rank_report); empty for one process

    /// What a session's scene took, and what its cache holds.
    void add_session(const SceneSession& session);
};

/// As JSON. Throws InputError for reports that are none.
[[nodiscard]] std::string statistics_json(const RunStatistics& statistics);

}  // namespace lightwalk
