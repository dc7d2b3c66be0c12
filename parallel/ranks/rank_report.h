#pragma once
// What a rank did, for statistics.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/transport/counters.h"
#include "parallel/comm/wire.h"
#include "parallel/ranks/timeline.h"
#include "parallel/work_queue/message.h"

namespace lightwalk {

/// How many messages a rank sent, and of how many bytes, by kind.
struct MessageCounts {
    std::array<std::uint64_t, kMessageKinds> messages{}, bytes{};
    void add(const Message& message, std::size_t size) {
        ++messages[message.index()];
        bytes[message.index()] += size;
    }
};

struct RankReport {
    std::string host;
    int threads = 1;  ///< that trace
    RayCounters rays;
    AmbientCounters ambient;
    std::vector<Timeline::Row> rows;  ///< of its threads; the last one is that of messages
    MessageCounts counts;
};

// On the wire, see wire.h.
template <>
inline constexpr int wire::kEnumerators<Activity> = kActivities;
template <class Wire>
void visit_fields(Wire& wire, Timeline::Span& span) {
    wire(span.activity, span.begin, span.end);
}
template <class Wire>
void visit_fields(Wire& wire, Timeline::Row& row) {
    wire(row.seconds, row.spans);
}
template <class Wire>
void visit_fields(Wire& wire, RayCounters& rays) {
    wire(rays.primary, rays.shadow, rays.specular, rays.transmitted, rays.ambient);
}
template <class Wire>
void visit_fields(Wire& wire, AmbientCounters& values) {
    wire(values.interpolated, values.computed, values.incomplete, values.waits, values.duplicates);
}
template <class Wire>
void visit_fields(Wire& wire, RankReport& report) {
    wire(report.host, report.threads, report.rays, report.ambient, report.rows,
         report.counts.messages, report.counts.bytes);
}

}  // namespace lightwalk
