#pragma once
// The one queue of shared work: workers request pieces of work, the queue grants them, whatever
// their payload is. Queue and workers are states with pure steps: a message in, messages out,
// nothing else, so that programs, tests and the scaling model run the very same ones.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "parallel/work_queue/block_supply.h"
#include "parallel/work_queue/outbox.h"
#include "parallel/work_queue/pixel_supply.h"
#include "parallel/work_queue/ray_supply.h"

namespace lightwalk {

/// What workers wait for, in the order of their requests.
class Requests {
  public:
    void add(int rank, std::uint32_t count) {
        if (count > 0) waiting_.push_back({rank, count});
    }
    /// Grants pieces of work, `next()` of which each gives one or nothing, as long as there are
    /// some.
    template <class Next>
    void grant(int self, Next next, Outbox& out) {
        while (!waiting_.empty()) {
            Request& first = waiting_.front();
            WorkGrant grant;
            while (first.count > 0) {
                std::optional<Work> piece = next();
                if (!piece) break;
                grant.pieces.push_back(*std::move(piece));
                --first.count;
            }
            const bool served = first.count == 0;
            if (!grant.pieces.empty()) out.messages.push_back({self, first.rank, std::move(grant)});
            if (!served) return;
            waiting_.pop_front();
        }
    }

  private:
    struct Request {
        int rank = 0;
        std::uint32_t count = 0;
    };
    std::deque<Request> waiting_;
};

/// On rank 0.
class WorkQueue {
  public:
    struct Options {
        std::vector<int> children;  ///< ranks that request work: workers and sub-queues
        std::size_t workers = 0;    ///< number of all workers
        std::vector<int> owners;    ///< of the parts of a walk's frames
        BlockPolicy blocks;
        std::uint32_t ray_window = 1;  ///< see RaySupply
    };
    explicit WorkQueue(Options options);

    // From the program.
    void start(PictureJob job, Outbox& out);
    void start(FrameOrder order, Outbox& out);
    void start(const ChangeOrder& order, Outbox& out) const { announce({order}, out); }
    /// Rays will come: asks for the first chunks.
    void open_stream(Outbox& out) { rays_.begin(out); }
    void add(RayChunk chunk, Outbox& out);

    // From other ranks.
    void handle(int from, const WorkRequest& request, Outbox& out);
    void handle(int from, UncachedPixels pixels, Outbox& out);
    void handle(int from, FinishedPart part, Outbox& out);
    void handle(RayAnswer answer, Outbox& out) { rays_.gather(std::move(answer), out); }

    [[nodiscard]] const BlockSupply& blocks() const { return blocks_; }

  private:
    void announce(const Announcement& announcement, Outbox& out) const;
    void grant(Outbox& out);
    [[nodiscard]] std::optional<Work> next();

    Options options_;
    BlockSupply blocks_;
    RaySupply rays_;
    PixelSupply pixels_;
    Requests requests_;
};

/// Between rank 0 and a group of workers: keeps a store of work for them, so that rank 0 has fewer
/// messages to answer.
class SubQueue {
  public:
    /// @param slots  threads that trace, of its workers together
    SubQueue(int self, std::vector<int> children, std::size_t slots)
        : self_(self), children_(std::move(children)), goal_(2 * slots) {}

    void begin(Outbox& out) { restock(out); }
    // From rank 0.
    void handle(const Announcement& announcement, Outbox& out) const;
    void handle(WorkGrant grant, Outbox& out);
    /// No more work comes.
    void finish(Outbox& out) const;
    // From its workers.
    void handle(int from, const WorkRequest& request, Outbox& out);

  private:
    void grant(Outbox& out);
    void restock(Outbox& out);

    int self_;
    std::vector<int> children_;
    std::size_t goal_;         ///< pieces in store or on their way
    std::size_t ordered_ = 0;  ///< on their way
    std::deque<Work> store_;
    std::optional<FrameNumber> frame_over_;  ///< not yet told
    Requests requests_;
    std::vector<FinishedWork> finished_;  ///< not yet told
};

}  // namespace lightwalk
