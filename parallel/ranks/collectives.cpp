#include "parallel/ranks/collectives.h"

#include <algorithm>

#include "core/error.h"

namespace lightwalk {

Collectives::Collectives(const Topology& topology, std::size_t owners) {
    const auto of = [&](Collective::Group group) -> std::vector<int>& {
        return members_[static_cast<std::size_t>(group)];
    };
    for (int rank = 0; rank < topology.ranks; ++rank) of(Collective::Group::all).push_back(rank);
    of(Collective::Group::shutdown) = of(Collective::Group::all);
    for (const Topology::Worker& worker : topology.workers)
        of(Collective::Group::workers).push_back(worker.rank);
    of(Collective::Group::owners) = of(Collective::Group::workers);
    of(Collective::Group::owners).resize(std::min(owners, topology.workers.size()));
}

void Collectives::handle(int from, Collective share, Outbox& out) {
    if (share.finished) {
        out.results.push_back(std::move(share));
        return;
    }
    const std::vector<int>& ranks = members(share.group);
    const auto place = std::lower_bound(ranks.begin(), ranks.end(), from);
    if (place == ranks.end() || *place != from || share.parts.size() > 1)
        throw InputError("a rank takes part in an operation that is not its own");
    const auto [found, fresh] = rounds_.try_emplace({share.group, share.round});
    Round& round = found->second;
    Collective& result = round.result;
    if (fresh) {
        result = {share.group, share.operation, share.round, true, {}, {}};
        result.parts.resize(share.operation == Collective::Operation::gather ? ranks.size() : 0);
        round.missing = ranks.size();
    }
    if (share.operation == Collective::Operation::gather && !share.parts.empty())
        result.parts[static_cast<std::size_t>(place - ranks.begin())] =
            std::move(share.parts.front());
    result.numbers.resize(std::max(result.numbers.size(), share.numbers.size()));
    for (std::size_t i = 0; i < share.numbers.size(); ++i) result.numbers[i] += share.numbers[i];
    if (--round.missing > 0) return;
    for (const int rank : ranks) out.messages.push_back({0, rank, result});
    rounds_.erase(found);
}

}  // namespace lightwalk
