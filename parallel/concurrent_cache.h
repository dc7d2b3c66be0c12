#pragma once
// The ambient cache that all threads of a process share. Lookups take no lock; insertions lock one
// shard.
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>

#include "core/ambient/ambient_cache.h"
#include "parallel/block_arena.h"
#include "parallel/claim_table.h"
#include "parallel/reach_box.h"

namespace lightwalk {

/// Any number of threads may look up and insert at the same time. A lookup sees every record whose
/// insertion had ended before it began. Records are never removed.
class ConcurrentCache final : public AmbientCache {
  public:
    explicit ConcurrentCache(const AmbientLimits& limits);
    [[nodiscard]] const AmbientLimits& limits() const override { return limits_; }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override;
    void insert(const AmbientRecord& record) override { insert_with_groups(record, {}); }
    [[nodiscard]] AmbientSum lookup_groups(const AmbientQuery& query, LeakTest leaks,
                                           std::span<std::array<double, 3>> groups) const override;
    void insert_with_groups(const AmbientRecord& record, std::span<const Rgb> groups) override;
    [[nodiscard]] AmbientLogMean log_mean() const override;
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return claims_.claim(query);
    }
    void release(const AmbientClaim& claim) override { claims_.release(claim); }
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    /// Bytes of everything that is allocated.
    [[nodiscard]] std::size_t memory_bytes() const {
        return sizeof(*this) + records_.memory_bytes() + groups_.memory_bytes() +
               families_.memory_bytes() + claims_.memory_bytes();
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    static constexpr std::size_t kShards = 64;
    struct Node {
        std::atomic<std::uint32_t> children{0};   ///< index of the family of children; 0: none
        std::atomic<std::uint32_t> first{kNone};  ///< first of a list of records, newest first
        ReachBox reach;  ///< region in which its records and those of its children are usable
    };
    struct alignas(128) Family {
        std::array<Node, 8> child;
    };
    struct alignas(64) Shard {
        mutable std::mutex mutex;
        AmbientLogMean log_mean;
    };
    std::uint32_t children_of(Node& node);
    struct Search;
    template <class Visit>
    static void for_reaching(const Family& family, const CachePath& parent, const Vec3& p,
                             Visit visit);
    [[nodiscard]] AmbientSum sum_all(const Search& search) const;
    void sum_node(const Node& node, const CachePath& cube, const Search& search,
                  AmbientSum& sum) const;
    void sum_records(std::uint32_t first, const Search& search, AmbientSum& sum) const;
    void add_groups(std::uint32_t number, const Search& search, AmbientSum& sum) const;

    AmbientLimits limits_;
    BlockArena<Family, 4> families_;  ///< the first child of the first is the root
    BlockArena<DecodedRecord, 6> records_;
    BlockArena<std::unique_ptr<Rgb[]>, 6> groups_;  ///< of each record, where groups are kept
    std::array<Shard, kShards> shards_;
    ClaimTable claims_;
};

}  // namespace lightwalk
