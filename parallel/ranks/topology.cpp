#include "parallel/ranks/topology.h"

#include <algorithm>
#include <string>

#include "core/error.h"

namespace lightwalk {
namespace {

/// One master answers so many without becoming what they wait for: the scaling model in perf/.
constexpr int kMostChildren = 256;

int chosen_masters(int masters, int ranks) {
    if (masters > 0) return masters;
    return ranks <= kMostChildren ? 1 : 1 + (ranks + kMostChildren - 1) / kMostChildren;
}

}  // namespace

std::optional<std::size_t> Topology::worker_index(int rank) const {
    const auto found = std::lower_bound(workers.begin(), workers.end(), rank,
                                        [](const Worker& w, int r) { return w.rank < r; });
    if (found == workers.end() || found->rank != rank) return std::nullopt;
    return static_cast<std::size_t>(found - workers.begin());
}

std::vector<int> Topology::worker_ranks() const {
    std::vector<int> found;
    found.reserve(workers.size());
    for (const Worker& worker : workers) found.push_back(worker.rank);
    return found;
}

bool Topology::below_sub_queue(int rank) const {
    const std::optional<std::size_t> worker = worker_index(rank);
    return worker && workers[*worker].queue != 0 && workers[*worker].queue != rank;
}

Topology make_topology(Variant variant, int ranks, bool ambient, int masters) {
    const int below = chosen_masters(masters, ranks) - 1;  // masters below rank 0
    Topology topology;
    topology.ranks = ranks;
    if (ambient) topology.ambient_master = variant == Variant::ranks ? 1 : 0;
    // Ranks that do nothing but answer messages come first.
    const int silent = variant == Variant::ranks ? 1 + (ambient ? 1 : 0) + below : 0;
    const int least = variant == Variant::ranks ? silent + std::max(1, below) : below + 1;
    if (ranks < least) {
        throw InputError("this way of sharing the work needs at least " + std::to_string(least) +
                         " ranks, not " + std::to_string(ranks));
    }
    for (int rank = silent; rank < ranks; ++rank) topology.workers.push_back({rank, 0});
    const std::vector<int> workers = topology.worker_ranks();
    if (below == 0) {
        topology.children = workers;
        return topology;
    }
    // Groups of workers that stand side by side. In `hybrid` rank 0 keeps a group of its own, and
    // the others' masters are the first of their workers.
    const bool hybrid = variant == Variant::hybrid;
    const auto groups = static_cast<std::size_t>(hybrid ? below + 1 : below);
    const std::size_t count = workers.size();
    for (std::size_t g = 0; g < groups; ++g) {
        const std::size_t begin = g * count / groups, end = (g + 1) * count / groups;
        std::vector<int> children(workers.begin() + static_cast<std::ptrdiff_t>(begin),
                                  workers.begin() + static_cast<std::ptrdiff_t>(end));
        if (hybrid && g == 0) {
            topology.children = std::move(children);
            continue;
        }
        const int rank = hybrid ? workers[begin] : 1 + (ambient ? 1 : 0) + static_cast<int>(g);
        for (std::size_t w = begin; w < end; ++w) topology.workers[w].queue = rank;
        topology.sub_queues.push_back({rank, std::move(children)});
        topology.children.push_back(rank);
    }
    return topology;
}

}  // namespace lightwalk
