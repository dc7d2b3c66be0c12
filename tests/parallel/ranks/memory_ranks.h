#pragma once
// Ranks that are threads of this process, each with its link.
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "parallel/ranks/rank_link.h"

namespace lightwalk::test {

/// How a run on ranks ended.
struct RankOutcome {
    std::vector<std::string> failures;  ///< what was told of ranks that could not go on
    std::vector<std::string> problems;  ///< by rank: what run() threw; "aborted" for Aborted
};

using Wires = std::vector<std::unique_ptr<Communicator>>;

/// Runs `body` on each rank of the topology.
inline RankOutcome run_ranks(const Topology& topology, const RankSettings& settings,
                             const std::function<void(RankLink& link)>& body, Wires wires,
                             const StopFlag& stop = {}) {
    RankOutcome outcome;
    outcome.problems.resize(wires.size());
    std::mutex mutex;  // guards the outcome
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < wires.size(); ++rank) {
        threads.emplace_back([&, rank] {
            const auto failed = [&](const std::string& message) {
                const std::lock_guard lock(mutex);
                outcome.failures.push_back(message);
            };
            RankLink link(*wires[rank], topology, settings, "test", failed);
            std::string problem;
            try {
                link.run([&] { body(link); }, stop);
            } catch (const Aborted&) {
                problem = "aborted";
            } catch (const std::exception& error) {
                problem = std::string("agreed: ") + error.what();
            }
            const std::lock_guard lock(mutex);
            outcome.problems[rank] = problem;
        });
    }
    for (std::thread& thread : threads) thread.join();
    return outcome;
}

inline RankOutcome run_ranks(const Topology& topology, const RankSettings& settings,
                             const std::function<void(RankLink& link)>& body,
                             const StopFlag& stop = {}) {
    return run_ranks(topology, settings, body, make_memory_communicators(topology.ranks), stop);
}

/// Whether all ranks' runs ended by themselves.
inline bool all_well(const RankOutcome& outcome) {
    bool well = outcome.failures.empty();
    for (const std::string& problem : outcome.problems) well = well && problem.empty();
    return well;
}

}  // namespace lightwalk::test
