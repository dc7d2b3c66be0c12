#pragma once
// The simulated machine: its processors and its network.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lightwalk {

/// Messages cost what LogGP says (Alexandrov, Ionescu, Schauser and Scheiman, "LogGP: incorporating
/// long messages into the LogP model", SPAA 1995): latency L, overhead o, gap g, and G a byte. All
/// times in seconds.
struct Machine {
    std::string name = "this machine";
    double latency = 1e-6;     ///< L: from one end of the wire to the other
    double overhead = 2e-6;    ///< o: processor time for a message, at either end
    double byte_work = 3e-10;  ///< processor time to make, copy and read a byte, at either end
    double gap = 1e-6;         ///< g: least time between two messages of one sender
    double byte_gap = 2e-10;   ///< G: time between two bytes on the wire
    double step = 1e-6;        ///< processor time of one step of a role

    /// true: message loops sleep between two polls, as RankLink does, and a message waits for the
    /// next poll. false: messages are handled when they arrive.
    bool sleeps = true;
    double oversleep = 60e-6;  ///< time by which sleeping takes longer than asked for
    double wake = 30e-6;       ///< time until a thread that is woken runs
    double look = 5e-6;        ///< processor time of a poll

    int node_cores = 1;  ///< cores of a node
    int node_ranks = 1;  ///< ranks on a node; 0: all ranks are on one node
    /// Relative time of tracing by number of busy cores of a node, 1 for one core; the last value
    /// holds for more cores as well.
    std::vector<double> crowding{1};
    double background = 0;  ///< threads of other programs on each node that are always ready to run
    double slowness = 1;    ///< processing times, relative to the machine of the cost map
    /// Whether rank 0 unpacks the parts of the picture, as the program does, or forwards them as
    /// they are, as the paper's did.
    bool unpacks = true;
    double value_work = 1e-6;  ///< processor time to add an ambient value that another rank made
};

/// A machine with the values of the named members, and defaults for the others. Throws InputError
/// for unknown names.
[[nodiscard]] Machine read_machine(const nlohmann::json& json);

}  // namespace lightwalk
