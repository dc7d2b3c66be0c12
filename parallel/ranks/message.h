#pragma once
// What ranks say to each other: typed messages, and how they look as bytes.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/view/pixels.h"
#include "parallel/ranks/cloud_messages.h"

namespace lightwalk {

/// What somebody is to the others. A rank may play several roles.
enum class Role : std::uint8_t {
    master,          ///< hands out blocks, gathers the pieces of pictures; does not trace
    worker,          ///< owns a part of the picture; asks for blocks in the name of its threads
    ambient_master,  ///< gathers ambient values and passes them on
    ambient_client,  ///< exchanges those of its rank with it
    // What is within a rank, and only talks to its own roles; but programs talk to each other.
    tracer,   ///< the threads that trace
    cache,    ///< the rank's ambient cache
    program,  ///< on rank 0: who wants pictures; on others: who waits for the end
};

struct Address {
    int rank = 0;
    Role role = Role::worker;
    friend bool operator==(const Address&, const Address&) = default;
};

/// Number of a picture, or of another piece of work that is handed out in blocks.
using JobId = std::uint32_t;

struct JobBlock {
    JobId job = 0;
    PixelRectangle block;
    friend bool operator==(const JobBlock&, const JobBlock&) = default;
};

/// To everyone, before the first block of a job.
struct JobStart {
    JobId job = 0;
    PixelRectangle area;         ///< all pixels of the job
    std::int32_t alignment = 1;  ///< blocks whose corners lie at multiples of it cost least
    bool keep = true;     ///< false: pixels are not wanted, only what tracing them leaves behind
    std::string payload;  ///< what the tracer makes of it: view and options
    /// Pixels that an earlier run has left; the program sends them to their owners.
    std::vector<PixelRectangle> known;
    bool log = false;  ///< the program of rank 0 wants every block's Pixels as well
    friend bool operator==(const JobStart&, const JobStart&) = default;
};

struct FinishedBlock {
    JobBlock work;
    double seconds = 0;  ///< that it took
    friend bool operator==(const FinishedBlock&, const FinishedBlock&) = default;
};

/// Worker to master: what is done, and how many blocks more are wanted.
struct AskBlocks {
    std::uint32_t count = 0;
    std::vector<FinishedBlock> finished;
    friend bool operator==(const AskBlocks&, const AskBlocks&) = default;
};

/// Master to worker. Fewer than were asked for are an instalment: the rest follows.
struct GiveBlocks {
    std::vector<JobBlock> blocks;
    friend bool operator==(const GiveBlocks&, const GiveBlocks&) = default;
};

/// Worker to the worker that owns these pixels, and to the program that logs them; from the program
/// to owners: what an earlier run has left.
struct Pixels {
    JobBlock work;
    std::vector<PixelValue> values;  ///< row by row from the bottom; none in simulations
    friend bool operator==(const Pixels&, const Pixels&) = default;
};

/// Tracer to its own rank's worker: a block is traced.
struct BlockDone {
    Pixels pixels;
    double seconds = 0;
    friend bool operator==(const BlockDone&, const BlockDone&) = default;
};

/// Worker to master: its whole part of a picture, compressed; and master to program.
struct PicturePiece {
    JobBlock work;
    std::string bytes;
    friend bool operator==(const PicturePiece&, const PicturePiece&) = default;
};

/// Master to program: all pieces of a picture are there.
struct FinishedPicture {
    JobId job = 0;
    std::vector<PicturePiece> pieces;
    friend bool operator==(const FinishedPicture&, const FinishedPicture&) = default;
};

/// Worker to ambient master: values that it computed. And the answer: those that others computed
/// since the last one. Also between a rank's cache and its worker.
struct AmbientValues {
    std::vector<AmbientRecord> records;
    std::uint32_t scene = 0;  ///< that they are of, where ranks render one after the other
};

/// Program to program of rank 0: this rank cannot go on.
struct Failure {
    std::string host;
    std::string text;
    friend bool operator==(const Failure&, const Failure&) = default;
};

/// Program of rank 0 to all others': no more work comes.
struct Finish {
    friend bool operator==(const Finish&, const Finish&) = default;
};
/// And their answer: what the rank did, as its program writes it.
struct Report {
    std::string payload;
    friend bool operator==(const Report&, const Report&) = default;
};

/// Bytes that every rank gives and all get, in the order of their ranks: rank to master, and the
/// master's answer, which holds all.
struct Gather {
    std::uint32_t round = 0;
    std::vector<std::string> parts;
    friend bool operator==(const Gather&, const Gather&) = default;
};

/// Master to program, now and then: how far a job is.
struct Progress {
    JobId job = 0;
    double done = 0;  ///< share of its pixels, 0 ... 1
    friend bool operator==(const Progress&, const Progress&) = default;
};

/// Worker to the master of rays, and that one to the program of rank 0: this many chunks more are
/// wanted.
struct AskChunks {
    std::uint32_t chunks = 0;
    std::uint32_t rays = 0;  ///< to the program: about so many in each
    friend bool operator==(const AskChunks&, const AskChunks&) = default;
};

/// Rays that one thread traces, on their way from the program of rank 0.
struct RayChunk {
    std::uint64_t number = 0;     ///< of the chunk, from 0
    std::uint64_t first = 0;      ///< number of its first ray among all rays of the input
    std::vector<double> numbers;  ///< six a ray: origin and direction
    [[nodiscard]] std::size_t rays() const { return numbers.size() / 6; }
    friend bool operator==(const RayChunk&, const RayChunk&) = default;
};

/// Tracer to worker, worker to master, master to program: what a chunk's rays say, as it is to be
/// written. From a worker it is also the wish for one chunk more.
struct ChunkAnswer {
    std::uint64_t number = 0;
    std::uint32_t rays = 0;
    double seconds = 0;  ///< that it took
    std::string bytes;
    friend bool operator==(const ChunkAnswer&, const ChunkAnswer&) = default;
};

using Message =
    std::variant<JobStart, AskBlocks, GiveBlocks, Pixels, BlockDone, PicturePiece, FinishedPicture,
                 AmbientValues, Failure, Finish, Report, Gather, Progress, AskChunks, RayChunk,
                 ChunkAnswer, CloudOrder, CloudPoints, CloudUsed, UncachedPixels, AskUncachedPixels,
                 GiveUncachedPixels, TracedPixelResults, CloudStage, CloudPart, FinishedFrame>;

inline constexpr std::size_t kMessageKinds = std::variant_size_v<Message>;
/// Of Message::index(), for statistics: "JobStart", ...
[[nodiscard]] const char* kind_name(std::size_t kind);

/// A message on its way.
struct Envelope {
    Address from, to;
    Message message;
};

/// All numbers little-endian. Byte 0: index of the kind in Message; 1: role of the sender, 2: of
/// the receiver; 3: format version; then the fields in the order of their declaration: integers as
/// they are, bool as one byte, double as its 64 bits, strings and lists after their length in 64
/// bits. An ambient record is 68 bytes: position 3 x f32, normal u32, axis u32, radius,
/// translation, rotation 2 x f32 each, value 3 x f32, weight f32, corral u32, level u8, three bytes
/// of zero: reals travel as they are, so that the copy is the same value. A point of the cloud is
/// 40 bytes, its fields in their order; a traced uncached pixel its value and the number of its
/// points as one byte, then these.
[[nodiscard]] std::string encode_message(const Envelope& envelope);

/// The inverse; ranks are those given. Throws InputError for bytes that no encode_message made:
/// kinds, roles, versions or lengths that cannot be.
[[nodiscard]] Envelope decode_message(std::string_view bytes, int from, int to);

/// Bytes of the message on the wire, without making them: for models of the time it takes.
[[nodiscard]] std::size_t message_bytes(const Message& message);

}  // namespace lightwalk
