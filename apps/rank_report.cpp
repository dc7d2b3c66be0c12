#include "apps/rank_report.h"

#include <nlohmann/json.hpp>

namespace lightwalk {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string thread_name(int row, int rows) {
    return row + 1 == rows ? "messages" : "thread " + std::to_string(row);
}

OrderedJson seconds_of(const Timeline& timeline) {
    OrderedJson all = OrderedJson::array();
    for (int row = 0; row < timeline.rows(); ++row) {
        const Timeline::Row seen = timeline.row(row);
        OrderedJson one{{"thread", thread_name(row, timeline.rows())}};
        for (std::size_t a = 0; a < kActivities; ++a) {
            if (seen.seconds[a] > 0) one[activity_name(static_cast<Activity>(a))] = seen.seconds[a];
        }
        all.push_back(std::move(one));
    }
    return all;
}

OrderedJson messages_of(const MessageCounts& counts) {
    OrderedJson all = OrderedJson::object();
    for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
        if (counts.messages[kind] > 0)
            all[kind_name(kind)] = {{"count", counts.messages[kind]},
                                    {"bytes", counts.bytes[kind]}};
    }
    return all;
}

OrderedJson spans_of(const RankLink& link) {
    OrderedJson all = OrderedJson::array();
    const Timeline& timeline = link.timeline();
    const auto seconds = [&](Timeline::Clock::time_point when) {
        return std::chrono::duration<double>(when - link.agreed()).count();
    };
    for (int row = 0; row < timeline.rows(); ++row) {
        for (const Timeline::Span& span : timeline.row(row).spans) {
            all.push_back(
                {row, static_cast<int>(span.activity), seconds(span.begin), seconds(span.end)});
        }
    }
    return all;
}

}  // namespace

std::string rank_report(const RankLink& link, int threads, const RayCounters& rays,
                        const AmbientCounters& ambient) {
    OrderedJson json{{"rank", link.rank()}, {"host", link.host()}, {"threads", threads}};
    json["rays"] = {{"primary", rays.primary},
                    {"shadow", rays.shadow},
                    {"specular", rays.specular},
                    {"transmitted", rays.transmitted},
                    {"ambient", rays.ambient}};
    json["ambient"] = {{"interpolated", ambient.interpolated},
                       {"computed", ambient.computed},
                       {"incomplete", ambient.incomplete},
                       {"waits", ambient.waits},
                       {"duplicates", ambient.duplicates}};
    json["seconds"] = seconds_of(link.timeline());
    json["messages"] = messages_of(link.counts());
    json["spans"] = spans_of(link);
    return json.dump();
}

void add_report(const std::string& report, RayCounters& rays, AmbientCounters& ambient) {
    const OrderedJson json = OrderedJson::parse(report);
    const OrderedJson& r = json.at("rays");
    rays +=
        {r.at("primary"), r.at("shadow"), r.at("specular"), r.at("transmitted"), r.at("ambient")};
    const OrderedJson& a = json.at("ambient");
    ambient += {a.at("interpolated"), a.at("computed"), a.at("incomplete"), a.at("waits"),
                a.at("duplicates")};
}

std::string timeline_json(const std::map<int, std::string>& reports) {
    OrderedJson events = OrderedJson::array();
    const auto name = [&](const char* what, int rank, int row, const std::string& text) {
        events.push_back(
            {{"name", what}, {"ph", "M"}, {"pid", rank}, {"tid", row}, {"args", {{"name", text}}}});
    };
    constexpr double kMicroseconds = 1e6;
    for (const auto& [rank, report] : reports) {
        const OrderedJson json = OrderedJson::parse(report);
        name("process_name", rank, 0,
             "rank " + std::to_string(rank) + " (" + json.at("host").get<std::string>() + ")");
        const int rows = static_cast<int>(json.at("seconds").size());
        for (int row = 0; row < rows; ++row) name("thread_name", rank, row, thread_name(row, rows));
        for (const OrderedJson& span : json.at("spans")) {
            const double begin = span[2], end = span[3];
            events.push_back({{"name", activity_name(static_cast<Activity>(span[1].get<int>()))},
                              {"ph", "X"},
                              {"pid", rank},
                              {"tid", span[0]},
                              {"ts", begin * kMicroseconds},
                              {"dur", (end - begin) * kMicroseconds}});
        }
    }
    return OrderedJson{{"traceEvents", std::move(events)}, {"displayTimeUnit", "ms"}}.dump();
}

}  // namespace lightwalk
