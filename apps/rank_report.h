#pragma once
// What each rank did, for --stats and --timeline.
#include <map>
#include <string>

#include "apps/rank_link.h"
#include "core/trace/tracer.h"

namespace lightwalk {

/// Of this rank, as JSON: host, threads, rays, ambient values, seconds by activity, messages and
/// bytes by kind, and every span of its timeline where these are kept.
[[nodiscard]] std::string rank_report(const RankLink& link, int threads, const RayCounters& rays,
                                      const AmbientCounters& ambient);

/// Adds what a rank reports to the counters of all.
void add_report(const std::string& report, RayCounters& rays, AmbientCounters& ambient);

/// The spans of all ranks in the format of Chrome's tracing, which Perfetto opens: a process a
/// rank, a thread a thread. See "Trace Event Format" (Google, 2016).
/// @param reports  by rank
[[nodiscard]] std::string timeline_json(const std::map<int, std::string>& reports);

}  // namespace lightwalk
