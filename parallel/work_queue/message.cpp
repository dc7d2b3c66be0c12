#include "parallel/work_queue/message.h"

#include <array>

#include "core/error.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

template <>
inline constexpr int wire::kEnumerators<FinishedWork::Payload> = 3;
template <>
inline constexpr int wire::kEnumerators<AmbientValues::Direction> = 2;
template <>
inline constexpr int wire::kEnumerators<Collective::Group> = kGroups;
template <>
inline constexpr int wire::kEnumerators<ChangeOrder::Step> = 3;

// Defines visit_fields for a type whose fields are listed.
#define LIGHTWALK_FIELDS(Type, ...)          \
    template <class Wire>                    \
    void visit_fields(Wire& wire, Type& m) { \
        wire(__VA_ARGS__);                   \
    }
LIGHTWALK_FIELDS(PictureJob, m.job, m.area, m.alignment, m.keep, m.payload, m.known, m.log)
LIGHTWALK_FIELDS(CloudRules, m.frame, m.empty, m.tightness)
LIGHTWALK_FIELDS(FrameOrder, m.number, m.width, m.height, m.rules, m.payload, m.budget,
                 m.most_points, m.rests, m.leaves, m.sample, m.refined, m.known, m.aside,
                 m.tells_origins, m.mixture, m.apart)
LIGHTWALK_FIELDS(ChangeOrder, m.number, m.step, m.payload, m.shown)
LIGHTWALK_FIELDS(Announcement, m.job)
LIGHTWALK_FIELDS(FinishedWork, m.payload, m.job, m.count, m.seconds, m.late)
LIGHTWALK_FIELDS(WorkRequest, m.count, m.finished)
LIGHTWALK_FIELDS(JobBlock, m.job, m.block)
LIGHTWALK_FIELDS(RayChunk, m.number, m.first, m.numbers)
LIGHTWALK_FIELDS(PixelRun, m.frame, m.owner, m.first, m.noise_pairs, m.at_once, m.places)
LIGHTWALK_FIELDS(WorkGrant, m.pieces, m.frame_over)
LIGHTWALK_FIELDS(Pixels, m.work, m.values, m.groups)
LIGHTWALK_FIELDS(LoggedPixels, m.pixels)
LIGHTWALK_FIELDS(RayAnswer, m.number, m.bytes)
LIGHTWALK_FIELDS(TracedRun, m.frame, m.owner, m.first, m.count, m.traced, m.groups, m.ahead)
LIGHTWALK_FIELDS(WorkResult, m.result)
LIGHTWALK_FIELDS(PicturePart, m.work, m.bytes, m.layers)
LIGHTWALK_FIELDS(CloudReport, m.pixels, m.reused, m.filled, m.inferred, m.uncached, m.points,
                 m.rays, m.project_seconds, m.check_seconds, m.trace_seconds, m.infer_seconds,
                 m.keep_seconds, m.tightness, m.audit_errors, m.audit_floors)
LIGHTWALK_FIELDS(FramePart, m.frame, m.area, m.pixels, m.unknown, m.report, m.origins, m.refined,
                 m.refined_groups)
LIGHTWALK_FIELDS(FinishedPart, m.part)
LIGHTWALK_FIELDS(UncachedPixels, m.frame, m.noise_pairs, m.places)
LIGHTWALK_FIELDS(SharedPoints, m.points, m.groups)
LIGHTWALK_FIELDS(UsedPixels, m.ahead, m.mirrored)
LIGHTWALK_FIELDS(PointExchange, m.frame, m.points)
LIGHTWALK_FIELDS(Collective, m.group, m.round, m.finished, m.parts, m.numbers)
LIGHTWALK_FIELDS(Failure, m.host, m.text)
LIGHTWALK_FIELDS(Report, m.payload)
LIGHTWALK_FIELDS(PreparedChange, m.number, m.problem, m.points, m.kept_points)
LIGHTWALK_FIELDS(Notice, m.notice)
#undef LIGHTWALK_FIELDS

template <class Wire>
void visit_fields(Wire&, Finish&) {}
template <class Wire>
void visit_fields(Wire&, Alive&) {}

template <class Wire>
void visit_fields(Wire& wire, AmbientValues& values) {
    wire(values.records, values.direction, values.groups, values.scene);
    const std::size_t records = values.records.size(), groups = values.groups.size();
    if (records == 0 ? groups > 0 : groups % records != 0)
        wire::refuse("hold light groups of no ambient value");
}

template <class Wire>
void visit_fields(Wire& wire, TracedPixelResult& pixel) {
    PixelPoints& left = pixel.points;
    auto count = static_cast<std::uint8_t>(left.count);
    wire(pixel.value, count);
    if (count > left.points.size()) wire::refuse("hold more points than a pixel leaves");
    left.count = count;
    for (std::size_t i = 0; i < count; ++i) wire(left.points[i]);
}

namespace {

constexpr std::uint8_t kVersion = 9;

}  // namespace

const char* kind_name(std::size_t kind) {
    static constexpr std::array<const char*, kMessageKinds> kNames{
        "Announcement",   "WorkRequest",   "WorkGrant",     "WorkResult", "FinishedPart",
        "UncachedPixels", "PointExchange", "AmbientValues", "Collective", "Notice"};
    return kNames[kind];
}

std::string encode_message(const Message& message) {
    wire::Writer writer;
    writer.bytes.reserve(message_bytes(message));
    std::uint8_t version = kVersion;
    writer(version, const_cast<Message&>(message));  // which a writer only looks at
    return std::move(writer.bytes);
}

std::size_t message_bytes(const Message& message) {
    return sizeof kVersion + wire::size_of(message);
}

Message decode_message(std::string_view bytes) {
    std::uint8_t version = 0;
    Message message;
    wire::Reader reader(bytes);
    reader(version);
    if (version != kVersion) wire::refuse("are of another version of the program");
    reader(message);
    if (!reader.at_end()) wire::refuse("are longer than they should be");
    return message;
}

}  // namespace lightwalk
