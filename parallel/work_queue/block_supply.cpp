#include "parallel/work_queue/block_supply.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "parallel/blocks.h"
#include "parallel/sub_images.h"

namespace lightwalk {
namespace {

constexpr int kFirstSide = 64;  ///< of blocks whose size is to follow what they take [pixels]
/// A block should take no less: handing it out takes a fraction of a millisecond.
constexpr double kLeastSeconds = 0.002;
/// Share of what is left that a thread is given at once: small enough that all end together
/// (Polychronopoulos and Kuck, "Guided Self-Scheduling", IEEE Transactions on Computers 1987).
constexpr double kShareAtOnce = 1.0 / 4;
/// The same where indirect light is looked for before a picture: in the first blocks almost every
/// pixel makes ambient values, in the last ones almost none does.
constexpr double kPrepassShareAtOnce = 1.0 / 32;
/// Where pixels of a picture make ambient values one of them takes as long as hundreds of others,
/// and those that make any lie side by side: blocks are as small as for so many times the threads.
/// But among a hundred threads they are small anyway, and would only be more messages.
constexpr int kTimesWithValues = 4, kMostWithValues = 128;

/// By how many threads what is left is shared.
int sharers(const BlockPolicy& policy, bool keep) {
    const int threads = std::max(1, policy.slots);
    if (!keep || !policy.makes_values) return threads;
    return std::max(threads, std::min(kTimesWithValues * threads, kMostWithValues));
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

void BlockSupply::start(const PictureJob& start, Outbox& out) {
    Job job;
    const int side = policy_.side > 0 ? policy_.side : kFirstSide;
    const std::size_t stride = policy_.stride > 0 ? static_cast<std::size_t>(policy_.stride)
                                                  : std::max<std::size_t>(1, workers_);
    job.blocks = in_strides(squares(start.area, rounded_to(side, start.alignment)), stride);
    if (!start.known.empty()) {
        const std::vector<Block> all(job.blocks.begin(), job.blocks.end());
        const std::vector<Block> left = blocks_left(all, start.known, start.alignment);
        job.blocks.assign(left.begin(), left.end());
    }
    for (const PixelRectangle& block : job.blocks)
        job.pixels_waiting += static_cast<double>(block.pixels());
    job.pixels_done = static_cast<double>(start.area.pixels()) - job.pixels_waiting;
    if (start.keep) {
        const SubImages parts(start.area, workers_);
        for (std::size_t i = 0; i < parts.size(); ++i)
            job.parts_missing += parts[i].empty() ? 0 : 1;
    }
    job.picture.job = start.job;
    job.start = start;
    if (start.keep && job.parts_missing == 0)
        out.program.emplace_back(std::move(job.picture));
    else
        jobs_.emplace(start.job, std::move(job));
}

std::optional<JobBlock> BlockSupply::next() {
    const auto job = std::find_if(jobs_.begin(), jobs_.end(),
                                  [](const auto& entry) { return !entry.second.blocks.empty(); });
    if (job == jobs_.end()) return std::nullopt;
    const JobBlock block = take_block(job->second);
    ++blocks_out_;
    // Nothing more comes of a job whose pixels nobody wants.
    if (!job->second.start.keep && job->second.blocks.empty()) jobs_.erase(job);
    return block;
}

/// With blocks of variable size a thread gets its share of what is left; until the first block is
/// back so little that every thread gets some.
JobBlock BlockSupply::take_block(Job& job) const {
    PixelRectangle block = job.blocks.front();
    job.blocks.pop_front();
    if (policy_.side == 0 || !job.start.keep) {
        const int alignment = job.start.alignment;
        const double share = job.start.keep ? kShareAtOnce : kPrepassShareAtOnce;
        double pixels = share * job.pixels_waiting / sharers(policy_, job.start.keep);
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

void BlockSupply::note(const FinishedWork& finished, Outbox& out) {
    --blocks_out_;
    const auto found = jobs_.find(finished.job);
    if (found == jobs_.end()) return;
    Job& job = found->second;
    job.pixels_done += finished.count;
    job.pixels_timed += finished.count;
    job.seconds_done += finished.seconds;
    const double share = job.pixels_done / static_cast<double>(job.start.area.pixels());
    out.program.emplace_back(Progress{finished.job, share});
}

void BlockSupply::gather(PicturePart part, Outbox& out) {
    const auto found = jobs_.find(part.work.job);
    if (found == jobs_.end()) return;
    Job& job = found->second;
    job.picture.parts.push_back(std::move(part));
    if (--job.parts_missing > 0) return;
    out.program.emplace_back(std::move(job.picture));
    jobs_.erase(found);
}

}  // namespace lightwalk
