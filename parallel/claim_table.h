#pragma once
// A table of the ambient values that are being computed, so that threads that need the same one at
// the same time do not all compute it.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

/// Claims are hints: a lost claim means that a value is computed twice, never a wrong one. A thread
/// that holds claims waits only for values of deeper levels than its own, which excludes deadlocks,
/// and only for a limited time.
class ClaimTable {
  public:
    /// `reach`: largest distance at which any value is used [m].
    explicit ClaimTable(double reach) : reach_(reach) {}

    /// Claim the value that the query asks for. Where a thread is computing one that will serve it,
    /// wait until that is done, or half as long as values took so far.
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query);
    /// Release a claim: the value has been stored, or will not be.
    void release(const AmbientClaim& claim);
    [[nodiscard]] std::size_t open() const;
    /// Bytes allocated beside the table object.
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Entry {
        std::uint64_t number = 0;
        AmbientQuery query;
        Clock::time_point start;
    };
    [[nodiscard]] const Entry* find(const AmbientQuery& query) const;
    [[nodiscard]] bool is_open(std::uint64_t number) const;

    double reach_;
    mutable std::mutex mutex_;
    std::condition_variable released_;
    std::vector<Entry> entries_;  ///< at most one for each thread and level
    std::uint64_t next_ = 1;
    Clock::duration usual_{};  ///< moving average of how long a value takes
};

}  // namespace lightwalk
