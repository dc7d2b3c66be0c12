#pragma once
// An ambient cache that can be frozen: it then takes no new values, and lookups are independent of
// scheduling.
#include "core/ambient/ambient_cache.h"

namespace lightwalk {

class FreezableCache final : public AmbientCache {
  public:
    explicit FreezableCache(AmbientCache& cache) : cache_(cache) {}
    /// Freeze the cache (new values are dropped), or open it again. Must not be called while rays
    /// are traced.
    void freeze(bool frozen) { frozen_ = frozen; }

    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override {
        if (!frozen_) cache_.insert(record);
    }
    [[nodiscard]] bool takes_values() const override { return !frozen_; }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }

    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return frozen_ ? AmbientClaim{} : cache_.claim(query);
    }
    void release(const AmbientClaim& claim) override { cache_.release(claim); }

  private:
    AmbientCache& cache_;
    bool frozen_ = false;
};

}  // namespace lightwalk
