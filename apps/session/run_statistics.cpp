#include "apps/session/run_statistics.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/session/scene_session.h"

namespace lightwalk {

void RunStatistics::add_session(const SceneSession& session) {
    scene = session.cost();
    if (!session.ambient) return;
    ambient_values = session.ambient->size();
    ambient_bytes = session.ambient->memory_bytes();
}

std::string statistics_json(const RunStatistics& s) {
    nlohmann::ordered_json json;
    json["version"] = LIGHTWALK_VERSION;
    json["command"] = s.command;
    json["threads"] = s.threads;
    if (s.ranks > 1) json["ranks"] = s.ranks;
    if (s.width > 0)
        json["picture"] = {{"width", s.width}, {"height", s.height}, {"frames", s.frames}};
    json["seconds"] = {{"read", s.scene.read_seconds},
                       {"build", s.scene.build_seconds},
                       {"render", s.render_seconds}};
    json["rays"] = {{"primary", s.rays.primary},   {"shadow", s.rays.shadow},
                    {"specular", s.rays.specular}, {"transmitted", s.rays.transmitted},
                    {"ambient", s.rays.ambient},   {"total", s.rays.total()}};
    if (s.ambient_values > 0 || s.ambient.computed > 0) {
        json["ambient"] = {
            {"interpolated", s.ambient.interpolated}, {"computed", s.ambient.computed},
            {"incomplete", s.ambient.incomplete},     {"waits", s.ambient.waits},
            {"duplicates", s.ambient.duplicates},     {"cached", s.ambient_values},
            {"cache_bytes", s.ambient_bytes}};
    }
    if (!s.walk.empty()) json["reuse"] = s.walk.json();
    json["rays_per_second"] =
        static_cast<double>(s.rays.total()) / std::max(s.render_seconds, 1e-9);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["peak_memory_bytes_until"] = {{"read", s.scene.read_peak_bytes},
                                       {"built", s.scene.build_peak_bytes}};
    for (const auto& [rank, report] : s.reports) {
        auto one = nlohmann::ordered_json::parse(report);
        one.erase("spans");
        json["per_rank"].push_back(std::move(one));
    }
    return json.dump(2) + "\n";
}

}  // namespace lightwalk
