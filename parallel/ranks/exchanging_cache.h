#pragma once
// An ambient cache whose new values go to other ranks, and which takes theirs.
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <utility>

#include "core/ambient/ambient_cache.h"
#include "parallel/ranks/message.h"

namespace lightwalk {

class ExchangingCache final : public AmbientCache {
  public:
    /// @param batch  values that `send` is called with at once, at least 1; it is called by
    ///               whichever thread made the last of them
    ExchangingCache(AmbientCache& cache, std::size_t batch, std::function<void(AmbientValues)> send)
        : cache_(cache), batch_(batch), send_(std::move(send)) {}

    /// Own values that do not make a batch yet, and need not be sent any more.
    [[nodiscard]] AmbientValues unsent() {
        const std::lock_guard lock(mutex_);
        return std::exchange(own_, {});
    }

    /// Values of other ranks, which are not sent on.
    void take(std::span<const AmbientRecord> records) {
        for (const AmbientRecord& record : records) cache_.insert(record);
    }

    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override {
        cache_.insert(record);
        AmbientValues full;
        {
            const std::lock_guard lock(mutex_);
            own_.records.push_back(record);
            if (own_.records.size() < batch_) return;
            full.records.swap(own_.records);
        }
        send_(std::move(full));
    }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return cache_.claim(query);
    }
    void release(const AmbientClaim& claim) override { cache_.release(claim); }

  private:
    AmbientCache& cache_;
    std::size_t batch_;
    std::function<void(AmbientValues)> send_;
    std::mutex mutex_;  ///< guards own_
    AmbientValues own_;
};

}  // namespace lightwalk
