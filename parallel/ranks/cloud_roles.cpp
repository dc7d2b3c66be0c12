#include "parallel/ranks/cloud_roles.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

// Pixels that are dealt out at once: a share of what is left, so that all end together, but enough
// that dealing them out takes little beside tracing them.
constexpr std::size_t kShares = 4, kFewest = 32, kMost = 1024;

[[noreturn]] void refuse() {
    throw InputError("a rank has sent a part of a frame that it should not have");
}

template <class T>
const WalkFrameId* frame_in(const Message& message) {
    const auto* found = std::get_if<T>(&message);
    return found != nullptr ? &found->frame : nullptr;
}

}  // namespace

CloudMasterRole::CloudMasterRole(Address self, std::vector<int> workers, std::size_t owners,
                                 int slots)
    : self_(self),
      workers_(std::move(workers)),
      slots_(static_cast<std::size_t>(std::max(slots, 1))),
      stores_(owners) {}

void CloudMasterRole::handle(Envelope envelope, Outbox& out) {
    const int from = envelope.from.rank;
    if (auto* order = std::get_if<CloudOrder>(&envelope.message)) {
        begin(std::move(*order), out);
    } else if (auto* uncached = std::get_if<UncachedPixels>(&envelope.message)) {
        store(from, std::move(*uncached));
        serve(out);
        tell_end(out);
    } else if (const auto* ask = std::get_if<AskUncachedPixels>(&envelope.message)) {
        wishes_.push_back({from, ask->count});
        serve(out);
        tell_end(out);
    } else if (auto* part = std::get_if<CloudPart>(&envelope.message)) {
        gather(from, std::move(*part), out);
    }
}

void CloudMasterRole::begin(CloudOrder order, Outbox& out) {
    if (drawing_) throw InputError("a frame is ordered before the last one is there");
    drawing_ = true;
    begun_ = ended_ = false;
    frame_ = order.rules.frame;
    untold_ = stores_.size();
    stores_.assign(stores_.size(), {});
    parts_.clear();
    for (const int rank : workers_) out.push_back({self_, {rank, Role::worker}, order});
}

void CloudMasterRole::store(int rank, UncachedPixels uncached) {
    const auto worker = std::find(workers_.begin(), workers_.end(), rank);
    const auto owner = static_cast<std::size_t>(worker - workers_.begin());
    if (!drawing_ || uncached.frame != frame_ || owner >= stores_.size() || stores_[owner].told ||
        uncached.noise_pairs > uncached.places.size())
        refuse();
    left_ += uncached.places.size();
    stores_[owner] = {true, false, std::move(uncached), 0};
    --untold_;
}

/// The owners' in turn, so that no owner's results pile up.
GiveUncachedPixels CloudMasterRole::next_piece() {
    while (stores_[turn_].next == stores_[turn_].uncached.places.size())
        turn_ = (turn_ + 1) % stores_.size();
    Store& store = stores_[turn_];
    const std::vector<PixelPlace>& places = store.uncached.places;
    const std::size_t own =
        places.size() - store.uncached.noise_pairs;  // those that are no noise pairs
    const bool noise_pairs = store.next >= own;
    const std::size_t end = noise_pairs ? places.size() : own;
    const std::size_t count =
        std::min(std::clamp(left_ / (kShares * slots_), kFewest, kMost), end - store.next);
    const auto first = places.begin() + static_cast<std::ptrdiff_t>(store.next);
    GiveUncachedPixels piece{frame_,
                             static_cast<std::uint32_t>(turn_),
                             static_cast<std::uint32_t>(store.next),
                             noise_pairs,
                             !std::exchange(begun_, true),
                             {first, first + static_cast<std::ptrdiff_t>(count)}};
    store.next += count;
    left_ -= count;
    turn_ = (turn_ + 1) % stores_.size();
    return piece;
}

void CloudMasterRole::serve(Outbox& out) {
    while (left_ > 0 && !wishes_.empty()) {
        Wish& wish = wishes_.front();
        if (wish.count == 0) {
            wishes_.pop_front();
            continue;
        }
        --wish.count;
        out.push_back({self_, {wish.rank, Role::worker}, next_piece()});
    }
}

/// To all, once a frame: nothing more of it comes.
void CloudMasterRole::tell_end(Outbox& out) {
    if (!drawing_ || untold_ > 0 || left_ > 0 || std::exchange(ended_, true)) return;
    for (const int rank : workers_)
        out.push_back(
            {self_, {rank, Role::worker}, GiveUncachedPixels{frame_, 0, 0, false, false, {}}});
}

void CloudMasterRole::gather(int rank, CloudPart part, Outbox& out) {
    const auto worker = std::find(workers_.begin(), workers_.end(), rank);
    const auto owner = static_cast<std::size_t>(worker - workers_.begin());
    if (!drawing_ || part.frame != frame_ || owner >= stores_.size() || !stores_[owner].told ||
        std::exchange(stores_[owner].finished, true))
        refuse();
    parts_.push_back(std::move(part));
    if (parts_.size() < stores_.size()) return;
    drawing_ = false;
    out.push_back({self_, {self_.rank, Role::program}, FinishedFrame{frame_, std::move(parts_)}});
}

void CloudWorkerRole::begin(Outbox& out) {
    out.push_back({options_.self, options_.master,
                   AskUncachedPixels{static_cast<std::uint32_t>(options_.slots + options_.ahead)}});
}

bool CloudWorkerRole::is_early(WalkFrameId frame) const {
    if (frame_ && frame < *frame_) refuse();
    return !frame_ || frame > *frame_;
}

void CloudWorkerRole::handle(Envelope envelope, Outbox& out) {
    Message& message = envelope.message;
    const WalkFrameId* frame = frame_in<CloudPoints>(message);
    if (frame == nullptr) frame = frame_in<CloudUsed>(message);
    if (frame == nullptr) frame = frame_in<TracedPixelResults>(message);
    if (frame != nullptr && is_early(*frame)) {
        early_.push_back(std::move(envelope));
        return;
    }
    if (const auto* order = std::get_if<CloudOrder>(&message)) {
        start(*order);
    } else if (std::holds_alternative<CloudPoints>(message)) {
        if (points_missing_-- == 0) refuse();
    } else if (std::holds_alternative<CloudUsed>(message)) {
        if (used_missing_-- == 0) refuse();
    } else if (const auto* traced = std::get_if<TracedPixelResults>(&message)) {
        note(*traced);
    } else if (const auto* uncached = std::get_if<UncachedPixels>(&message)) {
        expect(*uncached);
    }
    const bool starts = std::holds_alternative<CloudOrder>(message);
    const bool own = std::holds_alternative<UncachedPixels>(message) ||
                     std::holds_alternative<CloudPart>(message);
    out.push_back({options_.self, own ? options_.master : tracer(), std::move(message)});
    tell_stages(out);
    if (!starts) return;
    for (Envelope& one : std::exchange(early_, {})) handle(std::move(one), out);
}

void CloudWorkerRole::start(const CloudOrder& order) {
    if (!pixels_told_ || (frame_ && order.rules.frame <= *frame_)) refuse();
    frame_ = order.rules.frame;
    if (!owns()) return;
    uncached_known_ = points_told_ = pixels_told_ = false;
    points_missing_ = used_missing_ = 0;
    if (order.rests) {  // nothing is projected
        points_told_ = true;
        return;
    }
    const PixelRectangle whole{0, 0, order.width, order.height};
    const SubImages parts(whole, options_.owners);
    points_missing_ = options_.owners - 1;
    used_missing_ = owners_beside(parts, options_.index, order.width, order.height).size();
}

void CloudWorkerRole::expect(const UncachedPixels& uncached) {
    if (!frame_ || uncached.frame != *frame_ || uncached_known_) refuse();
    uncached_known_ = true;
    pixels_missing_ = uncached.places.size();
    there_.assign(pixels_missing_, false);
}

void CloudWorkerRole::note(const TracedPixelResults& traced) {
    const std::size_t end = std::size_t{traced.first} + traced.count;
    const bool whole = traced.traced.empty() || traced.traced.size() == traced.count;
    if (!uncached_known_ || !whole || end > there_.size()) refuse();
    for (std::size_t i = traced.first; i < end; ++i) {
        if (there_[i]) refuse();
        there_[i] = true;
    }
    pixels_missing_ -= traced.count;
}

void CloudWorkerRole::tell_stages(Outbox& out) {
    if (!points_told_ && points_missing_ == 0) {
        points_told_ = true;
        out.push_back({options_.self, tracer(), CloudStage{*frame_, CloudStage::Kind::points}});
    }
    if (!pixels_told_ && uncached_known_ && pixels_missing_ == 0 && used_missing_ == 0) {
        pixels_told_ = true;
        out.push_back({options_.self, tracer(), CloudStage{*frame_, CloudStage::Kind::pixels}});
    }
}

std::vector<std::size_t> owners_beside(const SubImages& parts, std::size_t index, int width,
                                       int height) {
    std::vector<std::size_t> found = parts.overlapping(widened(parts[index], 1, width, height));
    std::erase(found, index);
    return found;
}

}  // namespace lightwalk
