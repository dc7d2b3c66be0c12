#include <algorithm>
#include <cmath>

#include "parallel/blocks.h"
#include "parallel/ranks/roles.h"

namespace lightwalk {
namespace {

constexpr int kFirstSide = 64;  ///< of blocks whose size is to follow what they take [pixels]
/// A block should take no less: handing it out takes a fraction of a millisecond.
constexpr double kLeastSeconds = 0.002;
/// Share of what is left that a thread is given at once: small enough that all end together
/// (Polychronopoulos and Kuck, "Guided Self-Scheduling", IEEE Transactions on Computers 1987).
constexpr double kShareAtOnce = 1.0 / 4;

/// `area` in squares of `side`, from the lower left, row by row.
std::vector<PixelRectangle> squares(const PixelRectangle& area, int side) {
    std::vector<PixelRectangle> found;
    if (area.empty()) return found;
    for (int y = area.y0 / side * side; y < area.y1; y += side) {
        for (int x = area.x0 / side * side; x < area.x1; x += side) {
            found.push_back({std::max(x, area.x0), std::max(y, area.y0),
                             std::min(x + side, area.x1), std::min(y + side, area.y1)});
        }
    }
    return found;
}

/// Every stride-th of the list, from the first, then from the second, and so on.
std::deque<PixelRectangle> in_strides(const std::vector<PixelRectangle>& list, std::size_t stride) {
    std::deque<PixelRectangle> order;
    for (std::size_t first = 0; first < std::min(stride, list.size()); ++first) {
        for (std::size_t i = first; i < list.size(); i += stride) order.push_back(list[i]);
    }
    return order;
}

int rounded_to(int side, int alignment) {
    return std::max(1, (side + alignment - 1) / alignment) * alignment;
}

}  // namespace

MasterRole::MasterRole(Address self, std::vector<Address> children, std::size_t workers,
                       BlockPolicy policy)
    : self_(self), children_(std::move(children)), workers_(workers), policy_(policy) {}

void MasterRole::handle(Envelope envelope, Outbox& out) {
    if (auto* start = std::get_if<JobStart>(&envelope.message)) {
        begin(std::move(*start), out);
    } else if (auto* ask = std::get_if<AskBlocks>(&envelope.message)) {
        for (const FinishedBlock& finished : ask->finished) note(finished, out);
        if (ask->count > 0) wishes_.push_back({envelope.from, ask->count});
        serve(out);
    } else if (auto* piece = std::get_if<PicturePiece>(&envelope.message)) {
        gather(std::move(*piece), out);
    }
}

void MasterRole::begin(JobStart start, Outbox& out) {
    Job job;
    const int side = policy_.side > 0 ? policy_.side : kFirstSide;
    const std::size_t stride = policy_.stride > 0 ? static_cast<std::size_t>(policy_.stride)
                                                  : std::max<std::size_t>(1, workers_);
    job.blocks = in_strides(squares(start.area, rounded_to(side, start.alignment)), stride);
    if (!start.known.empty()) {
        const std::vector<Block> all(job.blocks.begin(), job.blocks.end());
        const std::vector<Block> left = blocks_left(all, start.known, start.alignment).left;
        job.blocks.assign(left.begin(), left.end());
    }
    for (const PixelRectangle& block : job.blocks)
        job.pixels_waiting += static_cast<double>(block.pixels());
    job.pixels_done = static_cast<double>(start.area.pixels()) - job.pixels_waiting;
    if (start.keep) {
        const SubImages parts(start.area, workers_);
        for (std::size_t i = 0; i < parts.size(); ++i)
            job.pieces_missing += parts[i].empty() ? 0 : 1;
    }
    job.picture.job = start.job;
    for (const Address& child : children_) out.push_back({self_, child, start});
    job.start = std::move(start);
    const JobId id = job.start.job;
    if (job.start.keep && job.pieces_missing == 0)
        out.push_back({self_, {self_.rank, Role::program}, job.picture});
    else
        jobs_.emplace(id, std::move(job));
    serve(out);
}

void MasterRole::note(const FinishedBlock& finished, Outbox& out) {
    --blocks_out_;
    const auto found = jobs_.find(finished.work.job);
    if (found == jobs_.end()) return;
    Job& job = found->second;
    job.pixels_done += static_cast<double>(finished.work.block.pixels());
    job.pixels_timed += static_cast<double>(finished.work.block.pixels());
    job.seconds_done += finished.seconds;
    const double share = job.pixels_done / static_cast<double>(job.start.area.pixels());
    out.push_back({self_, {self_.rank, Role::program}, Progress{job.start.job, share}});
}

JobBlock MasterRole::take_block(Job& job) {
    PixelRectangle block = job.blocks.front();
    job.blocks.pop_front();
    if (policy_.side == 0) {
        // What is left, dealt out in shares; until the first block is back: so that every thread
        // gets some.
        const int alignment = job.start.alignment;
        double pixels = kShareAtOnce * job.pixels_waiting / std::max(1, policy_.slots);
        if (job.seconds_done > 0)
            pixels = std::max(pixels, kLeastSeconds * job.pixels_timed / job.seconds_done);
        while (static_cast<double>(block.pixels()) > 1.5 * pixels &&
               std::max(block.width(), block.height()) > alignment) {
            const std::vector<Block> parts = quarters(block, alignment);
            if (parts.size() < 2) break;
            block = parts.front();
            job.blocks.insert(job.blocks.begin(), parts.begin() + 1, parts.end());
        }
    }
    job.pixels_waiting -= static_cast<double>(block.pixels());
    return {job.start.job, block};
}

void MasterRole::serve(Outbox& out) {
    while (!wishes_.empty()) {
        auto job = std::find_if(jobs_.begin(), jobs_.end(),
                                [](const auto& entry) { return !entry.second.blocks.empty(); });
        if (job == jobs_.end()) return;
        Wish& wish = wishes_.front();
        GiveBlocks given;
        while (wish.blocks > 0 && !job->second.blocks.empty()) {
            given.blocks.push_back(take_block(job->second));
            --wish.blocks;
            ++blocks_out_;
        }
        out.push_back({self_, wish.child, std::move(given)});
        if (wish.blocks == 0) wishes_.pop_front();
        // Nothing more comes of a job whose pixels nobody wants.
        if (!job->second.start.keep && job->second.blocks.empty()) jobs_.erase(job);
    }
}

void MasterRole::gather(PicturePiece piece, Outbox& out) {
    const auto found = jobs_.find(piece.work.job);
    if (found == jobs_.end()) return;
    Job& job = found->second;
    job.picture.pieces.push_back(std::move(piece));
    if (--job.pieces_missing > 0) return;
    out.push_back({self_, {self_.rank, Role::program}, std::move(job.picture)});
    jobs_.erase(found);
}

SubMasterRole::SubMasterRole(Address self, Address parent, std::vector<Address> children,
                             std::size_t slots)
    : self_(self), parent_(parent), children_(std::move(children)), goal_(2 * slots) {}

void SubMasterRole::handle(Envelope envelope, Outbox& out) {
    if (auto* ask = std::get_if<AskBlocks>(&envelope.message)) {
        finished_.insert(finished_.end(), ask->finished.begin(), ask->finished.end());
        if (ask->count > 0) wishes_.emplace_back(envelope.from, ask->count);
        serve(out);
        restock(out);
    } else if (auto* given = std::get_if<GiveBlocks>(&envelope.message)) {
        ordered_ -= given->blocks.size();
        store_.insert(store_.end(), given->blocks.begin(), given->blocks.end());
        serve(out);
        restock(out);
    } else {  // the start of a job
        for (const Address& child : children_) out.push_back({self_, child, envelope.message});
    }
}

void SubMasterRole::serve(Outbox& out) {
    while (!wishes_.empty() && !store_.empty()) {
        auto& [child, count] = wishes_.front();
        GiveBlocks given;
        for (; count > 0 && !store_.empty(); --count) {
            given.blocks.push_back(store_.front());
            store_.pop_front();
        }
        out.push_back({self_, child, std::move(given)});
        if (count == 0) wishes_.pop_front();
    }
}

/// Orders by the quarter, so that a message to rank 0 stands for many of the workers'.
void SubMasterRole::restock(Outbox& out) {
    const std::size_t coming = store_.size() + ordered_;
    if (coming + std::max<std::size_t>(1, goal_ / 4) > goal_) return;
    const std::size_t count = goal_ - coming;
    ordered_ += count;
    out.push_back({self_, parent_,
                   AskBlocks{static_cast<std::uint32_t>(count), std::exchange(finished_, {})}});
}

}  // namespace lightwalk
