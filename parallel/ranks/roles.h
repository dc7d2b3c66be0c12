#pragma once
// What ranks do when a message comes. Each role is a state and a pure step: a message in, messages
// out, nothing else: so that programs, tests and the scaling model run the very same roles.
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "parallel/ranks/message.h"
#include "parallel/ranks/topology.h"

namespace lightwalk {

/// Messages that a step sends, in order.
using Outbox = std::vector<Envelope>;

struct BlockPolicy {
    int side = 0;    ///< of blocks [pixels]; 0: follows what blocks take
    int stride = 0;  ///< consecutive blocks lie so many apart; 0: the number of workers
    int slots = 1;   ///< threads that trace, of all workers together
};

/// Hands out the blocks of jobs, in their order, and gathers the pieces of pictures.
class MasterRole {
  public:
    /// @param self      its own address, which messages come from
    /// @param children  who asks for blocks: workers and sub-masters
    /// @param workers   number of all workers: each sends a piece of every picture
    MasterRole(Address self, std::vector<Address> children, std::size_t workers,
               BlockPolicy policy);

    /// From children: AskBlocks. From workers: PicturePiece. From the program: JobStart. To the
    /// program: Progress, FinishedPicture.
    void handle(Envelope envelope, Outbox& out);

    /// Blocks that were handed out and are not finished.
    [[nodiscard]] std::size_t blocks_out() const { return blocks_out_; }

  private:
    struct Job {
        JobStart start;
        std::deque<PixelRectangle> blocks;          ///< to be handed out
        double pixels_waiting = 0;                  ///< in these
        double pixels_done = 0;                     ///< in this run or an earlier one
        double pixels_timed = 0, seconds_done = 0;  ///< in this run
        std::size_t pieces_missing = 0;
        FinishedPicture picture;
    };
    struct Wish {
        Address child;
        std::uint32_t blocks = 0;
    };
    void begin(JobStart start, Outbox& out);
    void note(const FinishedBlock& finished, Outbox& out);
    void serve(Outbox& out);
    [[nodiscard]] JobBlock take_block(Job& job);
    void gather(PicturePiece piece, Outbox& out);

    Address self_;
    std::vector<Address> children_;
    std::size_t workers_;
    BlockPolicy policy_;
    std::map<JobId, Job> jobs_;  ///< oldest first; until their last piece or block is there
    std::deque<Wish> wishes_;
    std::size_t blocks_out_ = 0;
};

/// Between rank 0 and a group of workers: keeps a store of blocks for them.
class SubMasterRole {
  public:
    /// @param slots  threads that trace, of its workers together
    SubMasterRole(Address self, Address parent, std::vector<Address> children, std::size_t slots);

    void begin(Outbox& out) { restock(out); }
    /// From workers: AskBlocks. From the parent: GiveBlocks, JobStart.
    void handle(Envelope envelope, Outbox& out);

  private:
    void serve(Outbox& out);
    void restock(Outbox& out);

    Address self_, parent_;
    std::vector<Address> children_;
    std::size_t goal_;         ///< blocks in store or on their way
    std::size_t ordered_ = 0;  ///< on their way
    std::deque<JobBlock> store_;
    std::deque<std::pair<Address, std::uint32_t>> wishes_;
    std::vector<FinishedBlock> finished_;  ///< not yet told
};

/// Makes bytes of a finished part of a picture.
using EncodePiece =
    std::function<std::string(const PixelRectangle& block, std::vector<PixelValue> values)>;

struct WorkerOptions {
    Address self;
    Address master;                                   ///< who gives it blocks
    std::size_t index = 0;                            ///< among the workers
    std::shared_ptr<const std::vector<int>> workers;  ///< ranks of all
    int slots = 1;                                    ///< threads that trace here
    int ahead = 1;  ///< blocks that wait here so that no thread does
    EncodePiece encode;
};

/// A job is forgotten when so many others have begun after it: programs keep no more open at once.
inline constexpr JobId kJobsAtOnce = 8;

/// Asks for blocks in the name of the rank's threads, and owns a part of every picture.
class WorkerRole {
  public:
    explicit WorkerRole(WorkerOptions options) : options_(std::move(options)) {}

    /// Asks for the first blocks.
    void begin(Outbox& out);
    /// From the master: JobStart, GiveBlocks: handed to the tracer. From the tracer: BlockDone.
    /// From other workers: Pixels.
    void handle(Envelope envelope, Outbox& out);

  private:
    struct Job {
        bool started = false;  ///< pixels may come before the word that they will
        bool keep = true, log = false;
        SubImages parts;                 ///< who owns what
        std::vector<PixelValue> values;  ///< of the own part, row by row from the bottom
        std::vector<bool> there;         ///< which of them
        std::size_t missing = 0;         ///< how many are not
        std::vector<Pixels> early;
    };
    void start(JobStart job, Outbox& out);
    void share_out(Pixels pixels, Outbox& out);
    void store(Pixels pixels, Outbox& out);
    [[nodiscard]] PixelRectangle own_part(const Job& job) const {
        return job.parts[options_.index];
    }

    WorkerOptions options_;
    std::map<JobId, Job> jobs_;  ///< the newest kJobsAtOnce
};

/// Gathers the ambient values of its clients and passes to each what the others found.
class AmbientMasterRole {
  public:
    explicit AmbientMasterRole(Address self) : self_(self) {}
    /// AmbientValues in, AmbientValues out. Of several scenes those of the last one are kept: the
    /// first values of a scene come when all ranks have left the one before.
    void handle(Envelope envelope, Outbox& out);
    [[nodiscard]] std::size_t size() const { return records_.size(); }

  private:
    Address self_;
    std::vector<AmbientRecord> records_;         ///< in the order of their arrival
    std::vector<int> sources_;                   ///< ranks they came from
    std::unordered_map<int, std::size_t> told_;  ///< records that a rank knows
    std::uint32_t scene_ = 0;                    ///< that they are of
};

/// The other end: a rank's own new values go out by the batch, one question at a time.
class AmbientClientRole {
  public:
    AmbientClientRole(Address self, Address master, std::size_t batch)
        : self_(self), master_(master), batch_(batch) {}
    /// AmbientValues from the own cache, and those of others for it. None from the cache: it wants
    /// to know what there is.
    void handle(Envelope envelope, Outbox& out);
    /// Ask, whether or not a batch is full.
    void ask(Outbox& out);
    [[nodiscard]] bool waits_for_answer() const { return asked_; }
    /// No more questions from now on.
    void close() { batch_ = static_cast<std::size_t>(-1); }

  private:
    Address self_, master_;
    std::size_t batch_;
    bool asked_ = false;
    AmbientValues own_;  ///< of the scene at hand
};

/// The pixels of `part` that lie in `block`, whose values are given (or none are).
[[nodiscard]] Pixels cut_pixels(const Pixels& pixels, const PixelRectangle& part);

}  // namespace lightwalk
