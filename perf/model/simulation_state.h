#pragma once
// What the simulation knows of each rank and of each block that is traced. For simulation*.cpp.
#include <optional>
#include <vector>

#include "perf/model/simulation.h"

namespace lightwalk {

inline constexpr double kPixelBytes = 16;  ///< of a pixel in a message
inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct Simulation::Rank {
    std::optional<RankRoles> roles;

    std::vector<Input> inbox;  ///< arrived or posted, not yet looked at
    double idle_from = 0;      ///< the loop has had nothing to do since
    double busy_until = 0;     ///< with messages
    double looks_at = kNever;  ///< when it will look next, if it matters
    double wire_free = 0;      ///< when its next message may leave
    double handling = 0;       ///< processor time of messages since the picture began

    std::vector<JobBlock> blocks;  ///< given, not yet begun
    std::size_t next_block = 0;    ///< of them
    int free_threads = 0;
    JobId set_up = 0;                ///< jobs whose renderer is there
    std::vector<bool> known;         ///< ambient values in the cache
    std::vector<AmbientRecord> own;  ///< values that have not been handed to the exchange
};

struct Simulation::Task {
    std::size_t rank = 0;
    JobBlock work;
    int next_row = 0;  ///< of pixels
    double began = 0;
    double setup = 0;                   ///< to be added to the first step
    std::vector<std::uint32_t> making;  ///< values that the present step makes
};

}  // namespace lightwalk
