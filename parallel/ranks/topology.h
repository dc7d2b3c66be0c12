#pragma once
// Who plays which role.
#include <cstddef>
#include <optional>
#include <vector>

namespace lightwalk {

/// How work is spread.
enum class Variant {
    threads,  ///< one process: no messages
    ranks,    ///< one thread a rank; master and ambient master do not trace
    hybrid,   ///< ranks of threads; rank 0 traces beside being the master
};

/// Roles of `ranks` ranks. Rank 0 is always the master that the others' queues answer to.
struct Topology {
    struct Worker {
        int rank = 0;
        int queue = 0;  ///< rank whose queue grants it work
    };
    /// A queue below that of rank 0: requests work there, by the dozen, for its own workers.
    struct SubQueue {
        int rank = 0;
        std::vector<int> children;  ///< ranks of these
    };
    int ranks = 1;
    std::vector<Worker> workers;
    std::vector<SubQueue> sub_queues;
    std::vector<int> children;          ///< ranks that rank 0 grants work: own workers, sub-queues
    std::optional<int> ambient_master;  ///< its rank, where ambient values are exchanged

    [[nodiscard]] bool traces(int rank) const { return worker_index(rank).has_value(); }
    [[nodiscard]] std::optional<std::size_t> worker_index(int rank) const;
    [[nodiscard]] std::vector<int> worker_ranks() const;
    /// Whether it hears of work from another rank's sub-queue, rather than from rank 0.
    [[nodiscard]] bool below_sub_queue(int rank) const;
};

/// @param ranks    at least 1 for `hybrid`; for `ranks` at least one worker beside master, ambient
///                 master and sub-masters. Throws InputError "... needs at least N ranks"
/// @param ambient  whether ambient values are exchanged
/// @param masters  number of all masters, rank 0 included; 0: as many as it takes that none has
///                 more than kMostChildren children
[[nodiscard]] Topology make_topology(Variant variant, int ranks, bool ambient, int masters);

}  // namespace lightwalk
