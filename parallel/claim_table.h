#pragma once
// Which ambient values are being computed, so that threads that miss the same one at the same time
// do not all compute it.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

/// Claims are hints: losing one costs a value that is computed twice, never a wrong one. Who holds
/// claims waits only for values of deeper levels than its own, so that nobody waits for himself,
/// and never for long.
class ClaimTable {
  public:
    /// `reach`: distance up to which any value serves its neighbours [m].
    explicit ClaimTable(double reach) : reach_(reach) {}

    /// Claim the value that the query asks for. Where a thread is computing one that will serve it,
    /// wait until that is done, or half as long as values took so far.
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query);
    /// The value is stored, or will not be.
    void release(const AmbientClaim& claim);
    [[nodiscard]] std::size_t open() const;
    /// Beside the table itself.
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
    std::vector<Entry> entries_;  ///< at most one a thread and level
    std::uint64_t next_ = 1;
    Clock::duration usual_{};  ///< moving average of how long a value takes
};

}  // namespace lightwalk
