#include "parallel/work_queue/work_queue.h"

#include <algorithm>
#include <utility>

namespace lightwalk {

WorkQueue::WorkQueue(Options options)
    : options_(std::move(options)),
      blocks_(options_.workers, options_.blocks),
      rays_(options_.ray_window),
      pixels_(options_.owners, options_.blocks.slots) {}

void WorkQueue::announce(const Announcement& announcement, Outbox& out) const {
    for (const int child : options_.children) out.messages.push_back({0, child, announcement});
}

void WorkQueue::start(PictureJob job, Outbox& out) {
    blocks_.start(job, out);
    announce({std::move(job)}, out);
    grant(out);
}

void WorkQueue::start(FrameOrder order, Outbox& out) {
    pixels_.start(order.number);
    announce({std::move(order)}, out);
}

void WorkQueue::add(RayChunk chunk, Outbox& out) {
    rays_.add(std::move(chunk));
    grant(out);
}

void WorkQueue::handle(int from, const WorkRequest& request, Outbox& out) {
    for (const FinishedWork& finished : request.finished) {
        switch (finished.payload) {
            case FinishedWork::Payload::block:
                blocks_.note(finished, out);
                break;
            case FinishedWork::Payload::rays:
                rays_.note(finished);
                break;
            case FinishedWork::Payload::pixels:
                pixels_.note(finished);
                break;
        }
    }
    requests_.add(from, request.count);
    grant(out);
}

void WorkQueue::handle(int from, UncachedPixels pixels, Outbox& out) {
    pixels_.add(from, std::move(pixels));
    grant(out);
}

void WorkQueue::handle(int from, FinishedPart part, Outbox& out) {
    std::visit(Overloaded{[&](PicturePart& one) { blocks_.gather(std::move(one), out); },
                          [&](FramePart& one) { pixels_.gather(from, std::move(one), out); }},
               part.part);
}

std::optional<Work> WorkQueue::next() {
    if (auto block = blocks_.next()) return *block;
    if (auto chunk = rays_.next()) return *std::move(chunk);
    if (auto run = pixels_.next()) return *std::move(run);
    return std::nullopt;
}

void WorkQueue::grant(Outbox& out) {
    requests_.grant(
        0, [this] { return next(); }, out);
    if (const auto frame = pixels_.over()) {
        for (const int child : options_.children)
            out.messages.push_back({0, child, WorkGrant{{}, frame}});
    }
}

void SubQueue::handle(const Announcement& announcement, Outbox& out) const {
    for (const int child : children_) out.messages.push_back({self_, child, announcement});
}

void SubQueue::finish(Outbox& out) const {
    for (const int child : children_)
        if (child != self_) out.messages.push_back({self_, child, Notice{Finish{}}});
}

void SubQueue::handle(WorkGrant given, Outbox& out) {
    ordered_ -= given.pieces.size();
    std::move(given.pieces.begin(), given.pieces.end(), std::back_inserter(store_));
    if (given.frame_over) frame_over_ = given.frame_over;
    grant(out);
    restock(out);
}

void SubQueue::handle(int from, const WorkRequest& request, Outbox& out) {
    finished_.insert(finished_.end(), request.finished.begin(), request.finished.end());
    requests_.add(from, request.count);
    grant(out);
    restock(out);
}

void SubQueue::grant(Outbox& out) {
    const auto next = [this]() -> std::optional<Work> {
        if (store_.empty()) return std::nullopt;
        Work piece = std::move(store_.front());
        store_.pop_front();
        return piece;
    };
    requests_.grant(self_, next, out);
    if (!frame_over_ || !store_.empty()) return;
    for (const int child : children_)
        out.messages.push_back({self_, child, WorkGrant{{}, frame_over_}});
    frame_over_.reset();
}

/// Orders by the quarter, so that a message to rank 0 stands for many of the workers'.
void SubQueue::restock(Outbox& out) {
    const std::size_t coming = store_.size() + ordered_;
    if (coming + std::max<std::size_t>(1, goal_ / 4) > goal_) return;
    const std::size_t count = goal_ - coming;
    ordered_ += count;
    out.messages.push_back(
        {self_, 0, WorkRequest{static_cast<std::uint32_t>(count), std::exchange(finished_, {})}});
}

}  // namespace lightwalk
