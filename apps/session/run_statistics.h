#pragma once
// What a run took, for --stats.
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "apps/session/compiled_scene.h"
#include "apps/session/walk_report.h"
#include "core/trace/tracer.h"
#include "parallel/adaptive_picture.h"
#include "parallel/ranks/rank_report.h"

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
    /// Of the newest picture that was drawn until it was good.
    struct Sampling {
        double error = 0;                  ///< relative, that 95 % of the pixels are within
        AdaptivePicture::Samples samples;  ///< a pixel
    };
    std::optional<Sampling> sampling;
    int ranks = 1;
    WalkReport walk;                    ///< frames that reused others' points
    std::map<int, RankReport> reports;  ///< of each rank; empty for one process

    /// What a session's scene took, and what its cache holds.
    void add_session(const SceneSession& session);
    /// The rays of another renderer of the same scene, and the values of its cache.
    void add_work(const RunStatistics& other) {
        rays += other.rays;
        ambient += other.ambient;
        ambient_values += other.ambient_values;
        ambient_bytes += other.ambient_bytes;
    }
};

/// As JSON.
[[nodiscard]] std::string statistics_json(const RunStatistics& statistics);

/// The spans of all ranks in the format of Chrome's tracing, which Perfetto opens: a process a
/// rank, a thread a thread. See "Trace Event Format" (Google, 2016).
[[nodiscard]] std::string timeline_json(const std::map<int, RankReport>& reports);

}  // namespace lightwalk
