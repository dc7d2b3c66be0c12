#pragma once
// The machine that is simulated: its processors and its network.
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
    double byte_work = 3e-10;  ///< processor time for a byte (made, copied, read), at either end
    double gap = 1e-6;         ///< g: between two messages of one sender
    double byte_gap = 2e-10;   ///< G: between two bytes on the wire
    double step = 1e-6;        ///< processor time of a role's step

    /// Whether who waits for messages sleeps between two looks, as RankLoop does: a message that
    /// arrives meanwhile waits for the next look. Else it is taken at once.
    bool sleeps = true;
    double oversleep = 60e-6;  ///< by which sleeping takes longer
    double wake = 30e-6;       ///< until a thread that is woken runs
    double look = 5e-6;        ///< processor time of a look

    int node_cores = 1;  ///< of a node
    int node_ranks = 1;  ///< that share them; 0: all ranks are on one node
    /// Time of tracing by number of busy cores of a node, one alone = 1; the last counts for more.
    std::vector<double> crowding{1};
    double background = 0;  ///< other programs' threads that always want a core, on each node
    double slowness = 1;    ///< time of all processing, beside the machine of the cost map
    bool unpacks =
        true;  ///< whether rank 0 makes pixels of the pieces, or passes them on as they are
    double value_work = 1e-6;  ///< processor time to add an ambient value that another rank made
};

/// Members that are named differ from the defaults. Throws InputError for names that are none.
[[nodiscard]] Machine read_machine(const nlohmann::json& json);

}  // namespace lightwalk
