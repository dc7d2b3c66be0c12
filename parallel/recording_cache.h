#pragma once
// An ambient cache that records insertions.
#include <utility>
#include <vector>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

/// Records the insertions by one thread until stop().
class RecordingCache final : public AmbientCache {
  public:
    explicit RecordingCache(AmbientCache& cache) : cache_(cache) {}
    /// Stop recording; returns what was inserted.
    [[nodiscard]] std::vector<AmbientRecord> stop() {
        recording_ = false;
        return std::exchange(records_, {});
    }

    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override {
        if (recording_) records_.push_back(record);
        cache_.insert(record);
    }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return cache_.claim(query);
    }
    void release(const AmbientClaim& claim) override { cache_.release(claim); }

  private:
    AmbientCache& cache_;
    bool recording_ = true;
    std::vector<AmbientRecord> records_;
};

}  // namespace lightwalk
