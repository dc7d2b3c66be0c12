#pragma once
// The ambient cache that a tracer uses: in front of the one that holds the values, it tells
// listeners of new ones, and can be closed.
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/ambient_listener.h"

namespace lightwalk {

/// As safe for threads as the cache behind it and the listeners are.
class PublishedCache final : public AmbientCache {
  public:
    /// @param cache  holds the values; must outlive this. What is inserted into it directly is not
    ///               published.
    explicit PublishedCache(AmbientCache& cache) : cache_(cache) {}

    /// Tell of values that are inserted from now on, after the listeners that are there. The
    /// listener must outlive this. Not while rays are traced.
    void add(AmbientListener& listener) { listeners_.push_back(&listener); }

    /// New values are dropped from now on, or kept again: while they are dropped, what is looked up
    /// does not depend on who computes what when. Not while rays are traced.
    void freeze(bool frozen) { frozen_ = frozen; }

    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override { insert_with_groups(record, {}); }
    [[nodiscard]] AmbientSum lookup_groups(const AmbientQuery& query, LeakTest leaks,
                                           std::span<std::array<double, 3>> groups) const override {
        return cache_.lookup_groups(query, leaks, groups);
    }
    void insert_with_groups(const AmbientRecord& record, std::span<const Rgb> groups) override {
        if (frozen_) return;
        cache_.insert_with_groups(record, groups);
        for (AmbientListener* listener : listeners_) listener->stored(record, groups);
    }
    /// Take over a value that a listener has from elsewhere, also while frozen: all other listeners
    /// are told of it.
    void take_over(const AmbientRecord& record, std::span<const Rgb> groups,
                   const AmbientListener& from) {
        cache_.insert_with_groups(record, groups);
        for (AmbientListener* listener : listeners_)
            if (listener != &from) listener->stored(record, groups);
    }
    [[nodiscard]] bool takes_values() const override { return !frozen_; }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }

    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return frozen_ ? AmbientClaim{} : cache_.claim(query);
    }
    void release(const AmbientClaim& claim) override { cache_.release(claim); }

  private:
    AmbientCache& cache_;
    std::vector<AmbientListener*> listeners_;
    bool frozen_ = false;
};

}  // namespace lightwalk
