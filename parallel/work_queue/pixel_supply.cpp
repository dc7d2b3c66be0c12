#include "parallel/work_queue/pixel_supply.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

// Pixels that are handed out at once: a share of what is left, so that all end together, but enough
// that handing them out takes little beside tracing them.
constexpr std::size_t kShares = 4, kFewest = 32, kMost = 1024;

[[noreturn]] void refuse() {
    throw InputError("a rank has sent a part of a frame that it should not have");
}

}  // namespace

PixelSupply::PixelSupply(std::vector<int> owners, int slots)
    : owners_(std::move(owners)),
      slots_(static_cast<std::size_t>(std::max(slots, 1))),
      stores_(owners_.size()) {}

void PixelSupply::start(FrameNumber frame) {
    if (drawing_) throw InputError("a frame is ordered before the last one is there");
    drawing_ = true;
    begun_ = over_ = late_ = false;
    frame_ = frame;
    untold_ = stores_.size();
    stores_.assign(stores_.size(), {});
    parts_.clear();
}

PixelSupply::Store& PixelSupply::store_of(int rank, FrameNumber frame) {
    const auto owner = std::find(owners_.begin(), owners_.end(), rank);
    if (!drawing_ || frame != frame_ || owner == owners_.end()) refuse();
    return stores_[static_cast<std::size_t>(owner - owners_.begin())];
}

void PixelSupply::add(int rank, UncachedPixels pixels) {
    Store& store = store_of(rank, pixels.frame);
    if (store.told || pixels.noise_pairs > pixels.places.size()) refuse();
    left_ += pixels.places.size();
    store = {true, false, std::move(pixels), 0};
    --untold_;
}

void PixelSupply::note(const FinishedWork& finished) {
    if (finished.late == frame_) late_ = true;
}

std::optional<PixelRun> PixelSupply::next() {
    if (left_ == 0) return std::nullopt;
    while (stores_[turn_].left() == 0) turn_ = (turn_ + 1) % stores_.size();
    Store& store = stores_[turn_];
    const std::vector<PixelPlace>& places = store.pixels.places;
    const std::size_t own = places.size() - store.pixels.noise_pairs;  // traced by their own rays
    const bool noise_pairs = store.next >= own;
    const std::size_t end = noise_pairs ? places.size() : own;
    const std::size_t share =
        late_ ? left_ : std::clamp(left_ / (kShares * slots_), kFewest, kMost);
    const std::size_t count = std::min(share, end - store.next);
    const auto first = places.begin() + static_cast<std::ptrdiff_t>(store.next);
    PixelRun run{frame_,
                 static_cast<std::uint32_t>(turn_),
                 static_cast<std::uint32_t>(store.next),
                 noise_pairs,
                 !std::exchange(begun_, true),
                 {first, first + static_cast<std::ptrdiff_t>(count)}};
    store.next += count;
    left_ -= count;
    turn_ = (turn_ + 1) % stores_.size();
    return run;
}

std::optional<FrameNumber> PixelSupply::over() {
    if (untold_ > 0 || left_ > 0 || std::exchange(over_, true)) return std::nullopt;
    return frame_;
}

void PixelSupply::gather(int rank, FramePart part, Outbox& out) {
    Store& store = store_of(rank, part.frame);
    if (!store.told || std::exchange(store.finished, true)) refuse();
    parts_.push_back(std::move(part));
    if (parts_.size() < stores_.size()) return;
    drawing_ = false;
    out.program.emplace_back(FinishedFrame{frame_, std::move(parts_)});
}

}  // namespace lightwalk
