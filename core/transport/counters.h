#pragma once
// Counters of traced rays and of indirect light, for statistics.
#include <cstdint>

namespace lightwalk {

/// Rays traced, by purpose.
struct RayCounters {
    std::uint64_t primary = 0, shadow = 0, specular = 0, transmitted = 0, ambient = 0;
    RayCounters& operator+=(const RayCounters& o);
    [[nodiscard]] std::uint64_t total() const {
        return primary + shadow + specular + transmitted + ambient;
    }
};

/// Ambient values that surfaces asked for, by how they were found.
struct AmbientCounters {
    std::uint64_t interpolated = 0;  ///< from the cache
    std::uint64_t computed = 0;      ///< by a hemisphere of rays
    std::uint64_t incomplete = 0;    ///< computed from fewer rays than wanted, and so not stored
    std::uint64_t waits = 0;         ///< for a value that another thread was computing
    std::uint64_t duplicates = 0;    ///< computed though another thread's value would have served
    AmbientCounters& operator+=(const AmbientCounters& o);
};

/// All counters of one thread.
struct TraceCounters {
    RayCounters rays;
    AmbientCounters ambient;
    TraceCounters& operator+=(const TraceCounters& o);
};

}  // namespace lightwalk
