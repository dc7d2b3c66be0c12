#include "parallel/ranks/message.h"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "core/error.h"

namespace lightwalk {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr char kVersion = 3;
constexpr std::size_t kHeadBytes = 4;

// Each kind of message lists its fields once, for writing, reading and counting alike.
template <class Archive, class T>
requires std::is_arithmetic_v<T>
void fields(Archive& archive, T& value) {
    archive.raw(&value, sizeof value);
}
template <class Archive>
void fields(Archive& archive, bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    fields(archive, byte);
    value = byte != 0;
}
template <class Archive>
void fields(Archive& archive, std::string& text) {
    archive.resize(text, 1);
    archive.raw(text.data(), text.size());
}
template <class Archive>
void fields(Archive& archive, PixelRectangle& r) {
    archive(r.x0, r.y0, r.x1, r.y1);
}
template <class Archive>
void fields(Archive& archive, JobBlock& work) {
    archive(work.job, work.block);
}
template <class Archive>
void fields(Archive& archive, FinishedBlock& block) {
    archive(block.work, block.seconds);
}
template <class Archive>
void fields(Archive& archive, std::array<float, 2>& pair) {
    archive(pair[0], pair[1]);
}
template <class Archive>
void fields(Archive& archive, Rgb& rgb) {
    archive(rgb.r, rgb.g, rgb.b);
}
template <class Archive>
void fields(Archive& archive, PixelValue& value) {
    archive(value.radiance, value.distance);
}
template <class Archive>
void fields(Archive& archive, AmbientRecord& r) {
    std::array<std::uint8_t, 3> nothing{};
    archive(r.position[0], r.position[1], r.position[2], r.normal, r.axis, r.radius, r.translation,
            r.rotation, r.value, r.weight, r.corral, r.level, nothing[0], nothing[1], nothing[2]);
}
template <class Archive>
void fields(Archive& archive, Pixels& m) {
    archive(m.work, m.values);
}
template <class Archive>
void fields(Archive& archive, PicturePiece& m) {
    archive(m.work, m.bytes);
}
/// Fewest bytes of one element on the wire: a length that promises more elements than bytes are
/// left cannot be.
template <class T>
constexpr std::size_t least_bytes() {
    if (std::is_same_v<T, AmbientRecord>) return 68;
    if (std::is_same_v<T, CloudPoint>) return 40;
    if (std::is_same_v<T, TracedPixelResult>) return 17;
    if (std::is_same_v<T, PixelValue>) return 16;
    if (std::is_same_v<T, PixelOrigin>) return 6;
    return std::is_same_v<T, float> ? 4 : 8;
}
template <class Archive, class T>
void fields(Archive& archive, std::vector<T>& list) {
    archive.resize(list, least_bytes<T>());
    for (T& element : list) fields(archive, element);
}

template <class Archive>
void fields(Archive& archive, JobStart& m) {
    archive(m.job, m.area, m.alignment, m.keep, m.payload, m.known, m.log);
}
template <class Archive>
void fields(Archive& archive, AskBlocks& m) {
    archive(m.count, m.finished);
}
template <class Archive>
void fields(Archive& archive, GiveBlocks& m) {
    archive(m.blocks);
}
template <class Archive>
void fields(Archive& archive, BlockDone& m) {
    archive(m.pixels, m.seconds);
}
template <class Archive>
void fields(Archive& archive, FinishedPicture& m) {
    archive(m.job, m.pieces);
}
template <class Archive>
void fields(Archive& archive, AmbientValues& m) {
    archive(m.records, m.scene);
}
template <class Archive>
void fields(Archive& archive, Failure& m) {
    archive(m.host, m.text);
}
template <class Archive>
void fields(Archive&, Finish&) {}
template <class Archive>
void fields(Archive& archive, Report& m) {
    archive(m.payload);
}
template <class Archive>
void fields(Archive& archive, Gather& m) {
    archive(m.round, m.parts);
}
template <class Archive>
void fields(Archive& archive, Progress& m) {
    archive(m.job, m.done);
}
template <class Archive>
void fields(Archive& archive, AskChunks& m) {
    archive(m.chunks, m.rays);
}
template <class Archive>
void fields(Archive& archive, RayChunk& m) {
    archive(m.number, m.first, m.numbers);
}
template <class Archive>
void fields(Archive& archive, ChunkAnswer& m) {
    archive(m.number, m.rays, m.seconds, m.bytes);
}

// Of walks.
template <class Archive, std::size_t kCount>
void fields(Archive& archive, std::array<std::size_t, kCount>& list) {
    for (std::size_t& number : list) archive(number);
}
/// Of an enumeration with so many values.
template <class Archive, class T>
void enumerator(Archive& archive, T& value, std::uint8_t count) {
    auto byte = static_cast<std::uint8_t>(value);
    archive(byte);
    if (byte >= count) throw InputError("a message between ranks holds what cannot be");
    value = static_cast<T>(byte);
}
template <class Archive>
void fields(Archive& archive, PixelPlace& place) {
    archive(place.x, place.y);
}
template <class Archive>
void fields(Archive& archive, CloudPoint& p) {
    archive(p.position[0], p.position[1], p.position[2], p.radiance, p.surface, p.direction,
            p.max_view_angle);
    enumerator(archive, p.kind, kPointKinds);
    archive(p.age, p.old, p.paired);
}
template <class Archive>
void fields(Archive& archive, TracedPixelResult& uncached_pixel) {
    auto count = static_cast<std::uint8_t>(uncached_pixel.points.count);
    archive(uncached_pixel.value, count);
    if (count > uncached_pixel.points.points.size())
        throw InputError("a message between ranks holds what cannot be");
    uncached_pixel.points.count = count;
    for (std::size_t i = 0; i < count; ++i) fields(archive, uncached_pixel.points.points[i]);
}
template <class Archive>
void fields(Archive& archive, CloudOrder& m) {
    CloudRules& rules = m.rules;
    archive(m.width, m.height, rules.frame, rules.empty, rules.tightness, rules.room.age,
            rules.room.share, m.payload, m.budget, m.rest_follows, m.rests, m.leaves, m.sample,
            m.refined);
}
template <class Archive>
void fields(Archive& archive, CloudPoints& m) {
    archive(m.frame, m.points);
}
template <class Archive>
void fields(Archive& archive, CloudUsed& m) {
    archive(m.frame, m.used.ahead, m.used.mirrored);
}
template <class Archive>
void fields(Archive& archive, UncachedPixels& m) {
    archive(m.frame, m.noise_pairs, m.places);
}
template <class Archive>
void fields(Archive& archive, AskUncachedPixels& m) {
    archive(m.count);
}
template <class Archive>
void fields(Archive& archive, GiveUncachedPixels& m) {
    archive(m.frame, m.owner, m.first, m.noise_pairs, m.at_once, m.places);
}
template <class Archive>
void fields(Archive& archive, TracedPixelResults& m) {
    archive(m.frame, m.first, m.count, m.traced);
}
template <class Archive>
void fields(Archive& archive, CloudStage& m) {
    archive(m.frame);
    enumerator(archive, m.kind, 2);
}
template <class Archive>
void fields(Archive& archive, CloudReport& r) {
    archive(r.pixels, r.reused, r.filled, r.uncached, r.points, r.rays, r.project_seconds,
            r.check_seconds, r.trace_seconds, r.keep_seconds, r.tightness, r.audit_errors,
            r.audit_floors);
}
template <class Archive>
void fields(Archive& archive, PixelOrigin& origin) {
    enumerator(archive, origin.kind, 4);
    archive(origin.samples, origin.order);
}
template <class Archive>
void fields(Archive& archive, CloudPart& m) {
    archive(m.frame, m.area, m.pixels, m.report, m.ages, m.origins, m.refined);
}
template <class Archive>
void fields(Archive& archive, FinishedFrame& m) {
    archive(m.frame, m.parts);
}

class Writer {
  public:
    explicit Writer(std::string& out) : out_(out) {}
    template <class... Fields>
    void operator()(Fields&... values) {
        (fields(*this, values), ...);
    }
    void raw(const void* data, std::size_t size) {
        out_.append(static_cast<const char*>(data), size);
    }
    template <class List>
    void resize(const List& list, std::size_t) {
        const std::uint64_t size = list.size();
        raw(&size, sizeof size);
    }

  private:
    std::string& out_;
};

class Counter {
  public:
    template <class... Fields>
    void operator()(Fields&... values) {
        (fields(*this, values), ...);
    }
    void raw(const void*, std::size_t size) { bytes += size; }
    template <class List>
    void resize(const List&, std::size_t) {
        bytes += sizeof(std::uint64_t);
    }
    std::size_t bytes = kHeadBytes;
};

class Reader {
  public:
    explicit Reader(std::string_view left) : left_(left) {}
    template <class... Fields>
    void operator()(Fields&... values) {
        (fields(*this, values), ...);
    }
    void raw(void* data, std::size_t size) {
        if (size > left_.size()) throw InputError("a message between ranks is cut short");
        if (size > 0) std::memcpy(data, left_.data(), size);
        left_.remove_prefix(size);
    }
    template <class List>
    void resize(List& list, std::size_t least) {
        std::uint64_t size = 0;
        raw(&size, sizeof size);
        if (size > left_.size() / least)
            throw InputError("a message between ranks promises more than it holds");
        list.resize(size);
    }
    [[nodiscard]] bool at_end() const { return left_.empty(); }

  private:
    std::string_view left_;
};

template <std::size_t i = 0>
Message default_message(std::size_t kind) {
    if constexpr (i + 1 < kMessageKinds) {
        if (kind != i) return default_message<i + 1>(kind);
    }
    return std::variant_alternative_t<i, Message>{};
}

}  // namespace

const char* kind_name(std::size_t kind) {
    static constexpr std::array<const char*, kMessageKinds> kNames{
        "JobStart",     "AskBlocks",       "GiveBlocks",    "Pixels",     "BlockDone",
        "PicturePiece", "FinishedPicture", "AmbientValues", "Failure",    "Finish",
        "Report",       "Gather",          "Progress",      "AskChunks",  "RayChunk",
        "ChunkAnswer",  "CloudOrder",      "CloudPoints",   "CloudUsed",  "CloudHoles",
        "AskHoles",     "GiveHoles",       "TracedHoles",   "CloudStage", "CloudPart",
        "FinishedFrame"};
    return kNames[kind];
}

std::string encode_message(const Envelope& envelope) {
    std::string bytes;
    bytes.reserve(message_bytes(envelope.message));
    bytes += static_cast<char>(envelope.message.index());
    bytes += static_cast<char>(envelope.from.role);
    bytes += static_cast<char>(envelope.to.role);
    bytes += kVersion;
    Writer writer(bytes);
    // Fields are listed once, for readers as well, so that they take what they could change.
    std::visit([&](auto& message) { fields(writer, message); },
               const_cast<Message&>(envelope.message));
    return bytes;
}

std::size_t message_bytes(const Message& message) {
    Counter counter;
    std::visit([&](auto& one) { fields(counter, one); }, const_cast<Message&>(message));
    return counter.bytes;
}

Envelope decode_message(std::string_view bytes, int from, int to) {
    if (bytes.size() < kHeadBytes) throw InputError("a message between ranks is cut short");
    const auto kind = static_cast<unsigned char>(bytes[0]);
    const auto sender = static_cast<unsigned char>(bytes[1]);
    const auto receiver = static_cast<unsigned char>(bytes[2]);
    constexpr auto kLastRole = static_cast<unsigned char>(Role::program);
    if (bytes[3] != kVersion) throw InputError("a message of another version of the program");
    if (kind >= kMessageKinds || sender > kLastRole || receiver > kLastRole)
        throw InputError("a message between ranks of an unknown kind");
    Envelope envelope{{from, static_cast<Role>(sender)},
                      {to, static_cast<Role>(receiver)},
                      default_message(kind)};
    Reader reader(bytes.substr(kHeadBytes));
    std::visit([&](auto& message) { fields(reader, message); }, envelope.message);
    if (!reader.at_end()) throw InputError("a message between ranks is longer than it should be");
    return envelope;
}

}  // namespace lightwalk
