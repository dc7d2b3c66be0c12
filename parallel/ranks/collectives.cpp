#include "parallel/ranks/collectives.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace lightwalk {

Collectives::Collectives(const Topology& topology, std::size_t owners) {
    std::vector<int> all(static_cast<std::size_t>(topology.ranks));
    std::iota(all.begin(), all.end(), 0);
    const std::vector<int> workers = topology.worker_ranks();
    const auto last = static_cast<std::ptrdiff_t>(std::min(owners, workers.size()));
    std::vector<int> in_rounds = workers;
    if (!topology.traces(0)) in_rounds.insert(in_rounds.begin(), 0);
    members_ = {
        std::move(all), workers, {workers.begin(), workers.begin() + last}, std::move(in_rounds)};
}

void Collectives::handle(int from, Collective share, Outbox& out) {
    if (share.finished) {
        out.results.push_back(std::move(share));
        return;
    }
    const std::vector<int>& ranks = members(share.group);
    const auto place = std::lower_bound(ranks.begin(), ranks.end(), from);
    if (place == ranks.end() || *place != from || share.parts.size() != 1)
        throw InputError("a rank takes part in an operation that is not its own");
    const auto [found, fresh] = rounds_.try_emplace({share.group, share.round});
    Round& round = found->second;
    Collective& result = round.result;
    if (fresh) {
        result = {share.group, share.round, true, std::vector<std::string>(ranks.size()), {}};
        round.missing = ranks.size();
    }
    result.parts[static_cast<std::size_t>(place - ranks.begin())] = std::move(share.parts.front());
    result.numbers.resize(std::max(result.numbers.size(), share.numbers.size()));
    for (std::size_t i = 0; i < share.numbers.size(); ++i) result.numbers[i] += share.numbers[i];
    if (--round.missing > 0) return;
    for (const int rank : ranks) out.messages.push_back({0, rank, result});
    rounds_.erase(found);
}

}  // namespace lightwalk
