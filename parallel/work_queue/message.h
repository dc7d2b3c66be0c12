#pragma once
// What ranks say to each other: ten kinds of message, and how they look as bytes.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/math/overloaded.h"
#include "parallel/work_queue/work.h"

namespace lightwalk {

/// Rank 0 to everyone, before the first piece of work of a picture or of a walk's frame, and where
/// the scene of a walk changes.
struct Announcement {
    std::variant<PictureJob, FrameOrder, ChangeOrder> job;
};

/// Worker to the queue: what is finished, and how many pieces of work more are wanted.
struct WorkRequest {
    std::uint32_t count = 0;
    std::vector<FinishedWork> finished;
};

/// The queue's answer. Fewer pieces than were asked for are an instalment: the rest follows.
struct WorkGrant {
    std::vector<Work> pieces;
    std::optional<FrameNumber> frame_over;  ///< no more pieces of this frame come
};

/// A block for the checkpoint of rank 0's program.
struct LoggedPixels {
    Pixels pixels;
};
/// What came of a piece of work, to who gathers it: pixels to the owner of that part of the picture
/// or frame, answers of rays to rank 0.
struct WorkResult {
    std::variant<Pixels, LoggedPixels, RayAnswer, TracedRun> result;
};

/// The owner's whole part of a picture, compressed.
struct PicturePart {
    JobBlock work;
    std::string bytes;
    std::vector<std::string> layers = {};  ///< of light groups, in the same way, with no distances
};
/// Owner to rank 0: its part is finished.
struct FinishedPart {
    std::variant<PicturePart, FramePart> part;
};

/// Owner to the queue: pixels of its part of a frame that are to be traced. Each owner says so once
/// a frame.
struct UncachedPixels {
    FrameNumber frame = 0;
    std::uint32_t noise_pairs = 0;   ///< so many of the last places are to be traced by other rays
    std::vector<PixelPlace> places;  ///< that runs name by their number
};

/// Points that the frame shows in the receiver's part, or a pixel beside it: from each owner to
/// each other one, once a frame.
struct SharedPoints {
    std::vector<CloudPoint> points;
    std::vector<Rgb> groups = {};  ///< what light groups add, by point, then group; empty: not kept
};
/// Owner to owner.
struct PointExchange {
    FrameNumber frame = 0;
    /// Or which of these points were used, to the owners of the parts beside the own one.
    std::variant<SharedPoints, UsedPixels> points;
};

/// Ambient values that ranks share.
struct AmbientValues {
    enum class Direction : std::uint8_t {
        offer,  ///< to the ambient master: values that the rank computed, and the wish for others'
        news,   ///< its answer: those that others computed since the last one
    };
    std::vector<AmbientRecord> records;
    Direction direction = Direction::offer;
    std::vector<Rgb> groups =
        {};  ///< what light groups add, by record, then group; empty: not kept
    /// Of which scene of a walk, by the number of its change; 0: as it was read. Values of another
    /// one than the receiver's are of no use there.
    std::uint64_t scene = 0;

    /// Of record i.
    [[nodiscard]] std::span<const Rgb> groups_of(std::size_t i) const {
        const std::size_t count = groups.size() / records.size();
        return std::span(groups).subspan(i * count, count);
    }
    void add(const AmbientRecord& record, std::span<const Rgb> of_record) {
        records.push_back(record);
        groups.insert(groups.end(), of_record.begin(), of_record.end());
    }
    void add(const AmbientValues& others) {
        records.insert(records.end(), others.records.begin(), others.records.end());
        groups.insert(groups.end(), others.groups.begin(), others.groups.end());
    }
};

/// All ranks of a group tell each other something: a rank's share to rank 0, and the result to all.
struct Collective {
    /// `rounds`: the workers, and rank 0.
    enum class Group : std::uint8_t { all, workers, owners, rounds };
    Group group = Group::all;
    std::uint32_t round = 0;             ///< of the group
    bool finished = false;               ///< whether it is the result
    std::vector<std::string> parts;      ///< a share has one; the result everyone's, by rank
    std::vector<std::uint64_t> numbers;  ///< of the result: everyone's, added up one by one
};
inline constexpr std::size_t kGroups = 4;

/// This rank cannot go on.
struct Failure {
    std::string host, text;
};
/// No more work comes.
struct Finish {};
/// This rank is still there (see Pulse).
struct Alive {};
/// What a rank did, as its program writes it.
struct Report {
    std::string payload;
};
/// Program to program.
struct Notice {
    std::variant<Failure, Finish, Report, PreparedChange, Alive> notice;
};

using Message = std::variant<Announcement, WorkRequest, WorkGrant, WorkResult, FinishedPart,
                             UncachedPixels, PointExchange, AmbientValues, Collective, Notice>;

inline constexpr std::size_t kMessageKinds = std::variant_size_v<Message>;
/// Name of a kind by its Message::index(), for statistics.
[[nodiscard]] const char* kind_name(std::size_t kind);

/// A message on its way between two ranks, or to the own one.
struct Envelope {
    int from = 0, to = 0;
    Message message;
};

/// Byte 0: format version; then the message as wire.h says: the index of its kind, then its fields
/// in the order of their declaration.
[[nodiscard]] std::string encode_message(const Message& message);

/// The inverse. Throws InputError for bytes that no encode_message made: kinds, versions or lengths
/// that cannot be.
[[nodiscard]] Message decode_message(std::string_view bytes);

/// Bytes of the message on the wire, without making them: for models of the time it takes.
[[nodiscard]] std::size_t message_bytes(const Message& message);

}  // namespace lightwalk
