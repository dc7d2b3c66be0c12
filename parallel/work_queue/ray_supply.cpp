#include "parallel/work_queue/ray_supply.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

constexpr double kGoodSeconds = 0.02;  ///< of a chunk: handing it out takes a fraction of a percent
constexpr double kFewestRays = 64, kMostRays = 4096;
/// What a chunk's time counts when the next one is there: the rays of a file may change.
constexpr double kMemory = 0.9;

}  // namespace

std::optional<RayChunk> RaySupply::next() {
    if (chunks_.empty()) return std::nullopt;
    RayChunk chunk = std::move(chunks_.front());
    chunks_.pop_front();
    return chunk;
}

void RaySupply::note(const FinishedWork& finished) {
    rays_ = kMemory * rays_ + finished.count;
    seconds_ = kMemory * seconds_ + finished.seconds;
}

void RaySupply::gather(RayAnswer answer, Outbox& out) {
    const std::uint64_t number = answer.number;
    early_.emplace(number, std::move(answer));
    std::uint32_t passed_on = 0;
    for (auto first = early_.begin(); first != early_.end() && first->first == next_;
         first = early_.erase(first), ++next_, ++passed_on)
        out.program.emplace_back(std::move(first->second));
    if (passed_on > 0) out.program.emplace_back(ChunksWanted{passed_on, good_size()});
}

std::uint32_t RaySupply::good_size() const {
    const double rays = seconds_ > 0 ? kGoodSeconds * rays_ / seconds_ : 0;
    return static_cast<std::uint32_t>(std::clamp(rays, kFewestRays, kMostRays));
}

}  // namespace lightwalk
