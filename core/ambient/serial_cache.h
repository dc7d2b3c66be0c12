#pragma once
// The cache for one thread: the specification of the concurrent one.
#include <vector>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

class SerialCache final : public AmbientCache {
  public:
    explicit SerialCache(const AmbientLimits& limits) : limits_(limits), nodes_(1) {}
    [[nodiscard]] const AmbientLimits& limits() const override { return limits_; }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override;
    void insert(const AmbientRecord& record) override;
    [[nodiscard]] AmbientLogMean log_mean() const override { return log_mean_; }
    [[nodiscard]] std::size_t size() const { return records_.size(); }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    struct Node {
        std::uint32_t children = 0;   ///< first of eight; 0: none
        std::uint32_t first = kNone;  ///< record; by level, then falling weight
    };
    void sum_node(const Node& node, const CachePath& cube, const AmbientQuery& query,
                  LeakTest leaks, AmbientSum& sum) const;
    void sum_records(const Node& node, const AmbientQuery& query, LeakTest leaks,
                     AmbientSum& sum) const;

    AmbientLimits limits_;
    std::vector<Node> nodes_;
    std::vector<DecodedRecord> records_;
    AmbientLogMean log_mean_;
};

}  // namespace lightwalk
