#include "apps/session/run_statistics.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/session/scene_session.h"

namespace lightwalk {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json_of(const RayCounters& rays) {
    return {{"primary", rays.primary},
            {"shadow", rays.shadow},
            {"specular", rays.specular},
            {"transmitted", rays.transmitted},
            {"ambient", rays.ambient}};
}

OrderedJson json_of(const AmbientCounters& values) {
    return {{"interpolated", values.interpolated},
            {"computed", values.computed},
            {"incomplete", values.incomplete},
            {"waits", values.waits},
            {"duplicates", values.duplicates}};
}

std::string thread_name(std::size_t row, std::size_t rows) {
    return row + 1 == rows ? "messages" : "thread " + std::to_string(row);
}

OrderedJson json_of(int rank, const RankReport& report) {
    OrderedJson json{{"rank", rank}, {"host", report.host}, {"threads", report.threads}};
    json["rays"] = json_of(report.rays);
    json["ambient"] = json_of(report.ambient);
    json["seconds"] = OrderedJson::array();
    for (std::size_t row = 0; row < report.rows.size(); ++row) {
        OrderedJson one{{"thread", thread_name(row, report.rows.size())}};
        for (std::size_t a = 0; a < kActivities; ++a) {
            const double seconds = report.rows[row].seconds[a];
            if (seconds > 0) one[kActivityNames[a]] = seconds;
        }
        json["seconds"].push_back(std::move(one));
    }
    json["messages"] = OrderedJson::object();
    for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
        const MessageCounts& counts = report.counts;
        if (counts.messages[kind] > 0)
            json["messages"][kind_name(kind)] = {{"count", counts.messages[kind]},
                                                 {"bytes", counts.bytes[kind]}};
    }
    return json;
}

}  // namespace

void RunStatistics::add_session(const SceneSession& session) {
    scene = session.cost();
    if (!session.ambient) return;
    ambient_values = session.ambient->size();
    ambient_bytes = session.ambient->memory_bytes();
}

std::string statistics_json(const RunStatistics& s) {
    OrderedJson json;
    json["version"] = LIGHTWALK_VERSION;
    json["command"] = s.command;
    json["threads"] = s.threads;
    if (s.ranks > 1) json["ranks"] = s.ranks;
    if (s.width > 0)
        json["picture"] = {{"width", s.width}, {"height", s.height}, {"frames", s.frames}};
    if (s.sampling)
        json["sampling"] = {{"error", s.sampling->error},
                            {"rays_a_pixel",
                             {{"least", s.sampling->samples.least},
                              {"mean", s.sampling->samples.mean},
                              {"most", s.sampling->samples.most}}}};
    json["seconds"] = {{"read", s.scene.read_seconds},
                       {"build", s.scene.build_seconds},
                       {"render", s.render_seconds}};
    json["rays"] = json_of(s.rays);
    json["rays"]["total"] = s.rays.total();
    if (s.ambient_values > 0 || s.ambient.computed > 0) {
        json["ambient"] = json_of(s.ambient);
        json["ambient"]["cached"] = s.ambient_values;
        json["ambient"]["cache_bytes"] = s.ambient_bytes;
    }
    if (!s.walk.empty()) json["reuse"] = s.walk.json();
    json["rays_per_second"] =
        static_cast<double>(s.rays.total()) / std::max(s.render_seconds, 1e-9);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["peak_memory_bytes_until"] = {{"read", s.scene.read_peak_bytes},
                                       {"built", s.scene.build_peak_bytes}};
    for (const auto& [rank, report] : s.reports) json["per_rank"].push_back(json_of(rank, report));
    return json.dump(2) + "\n";
}

std::string timeline_json(const std::map<int, RankReport>& reports) {
    OrderedJson events = OrderedJson::array();
    const auto name = [&](const char* what, int rank, std::size_t row, const std::string& text) {
        events.push_back(
            {{"name", what}, {"ph", "M"}, {"pid", rank}, {"tid", row}, {"args", {{"name", text}}}});
    };
    constexpr double kMicroseconds = 1e6;
    for (const auto& [rank, report] : reports) {
        name("process_name", rank, 0, "rank " + std::to_string(rank) + " (" + report.host + ")");
        for (std::size_t row = 0; row < report.rows.size(); ++row) {
            name("thread_name", rank, row, thread_name(row, report.rows.size()));
            for (const Timeline::Span& span : report.rows[row].spans)
                events.push_back({{"name", kActivityNames[static_cast<std::size_t>(span.activity)]},
                                  {"ph", "X"},
                                  {"pid", rank},
                                  {"tid", row},
                                  {"ts", span.begin * kMicroseconds},
                                  {"dur", (span.end - span.begin) * kMicroseconds}});
        }
    }
    return OrderedJson{{"traceEvents", std::move(events)}, {"displayTimeUnit", "ms"}}.dump();
}

}  // namespace lightwalk
