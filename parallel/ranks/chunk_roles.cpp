#include "parallel/ranks/chunk_roles.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

constexpr double kGoodSeconds = 0.02;  ///< of a chunk: handing it out takes a fraction of a percent
constexpr double kFewestRays = 64, kMostRays = 4096;
/// What a chunk's time counts when the next one is there: the rays of a file may change.
constexpr double kMemory = 0.9;

}  // namespace

void ChunkMasterRole::begin(Outbox& out) {
    out.push_back({self_, {self_.rank, Role::program}, AskChunks{window_, good_size()}});
}

void ChunkMasterRole::handle(Envelope envelope, Outbox& out) {
    if (auto* chunk = std::get_if<RayChunk>(&envelope.message)) {
        chunks_.push_back(std::move(*chunk));
    } else if (const auto* ask = std::get_if<AskChunks>(&envelope.message)) {
        wishes_.insert(wishes_.end(), ask->chunks, envelope.from);
    } else if (auto* answer = std::get_if<ChunkAnswer>(&envelope.message)) {
        wishes_.push_back(envelope.from);
        settle(std::move(*answer), out);
    }
    serve(out);
}

std::uint32_t ChunkMasterRole::good_size() const {
    const double rays = seconds_ > 0 ? kGoodSeconds * rays_ / seconds_ : 0;
    return static_cast<std::uint32_t>(std::clamp(rays, kFewestRays, kMostRays));
}

void ChunkMasterRole::settle(ChunkAnswer answer, Outbox& out) {
    rays_ = kMemory * rays_ + answer.rays;
    seconds_ = kMemory * seconds_ + answer.seconds;
    const std::uint64_t number = answer.number;
    early_.emplace(number, std::move(answer));
    std::uint32_t settled = 0;
    const Address program{self_.rank, Role::program};
    for (auto first = early_.begin(); first != early_.end() && first->first == next_;
         first = early_.erase(first), ++next_, ++settled)
        out.push_back({self_, program, std::move(first->second)});
    if (settled > 0) out.push_back({self_, program, AskChunks{settled, good_size()}});
}

void ChunkMasterRole::serve(Outbox& out) {
    while (!wishes_.empty() && !chunks_.empty()) {
        out.push_back({self_, wishes_.front(), std::move(chunks_.front())});
        wishes_.pop_front();
        chunks_.pop_front();
    }
}

void ChunkWorkerRole::begin(Outbox& out) {
    out.push_back({self_, master_, AskChunks{wanted_, 0}});
}

void ChunkWorkerRole::handle(Envelope envelope, Outbox& out) {
    const bool answer = std::holds_alternative<ChunkAnswer>(envelope.message);
    out.push_back(
        {self_, answer ? master_ : Address{self_.rank, Role::tracer}, std::move(envelope.message)});
}

}  // namespace lightwalk
