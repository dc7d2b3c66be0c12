#pragma once
// The ambient cache that all threads of a process share. Looking up takes no lock; storing takes
// that of one shard.
#include <array>
#include <atomic>
#include <memory>
#include <mutex>

#include "core/ambient/ambient_cache.h"
#include "parallel/claim_table.h"
#include "parallel/reach_box.h"

namespace lightwalk {

/// Values in blocks that never move, by index. Blocks are made when they are first needed, and
/// freed with the arena.
template <class Value, unsigned kBlockBits>
class BlockArena {
  public:
    static constexpr std::uint32_t kBlock = 1U << kBlockBits;
    static constexpr std::size_t kMostBlocks = 1U << 14;

    BlockArena() : blocks_(std::make_unique<std::array<std::atomic<Value*>, kMostBlocks>>()) {
        for (std::atomic<Value*>& block : *blocks_) block.store(nullptr, std::memory_order_relaxed);
    }
    ~BlockArena() {
        for (std::atomic<Value*>& block : *blocks_) delete[] block.load(std::memory_order_relaxed);
    }
    BlockArena(const BlockArena&) = delete;
    BlockArena& operator=(const BlockArena&) = delete;

    [[nodiscard]] Value& operator[](std::uint32_t i) const {
        return (*blocks_)[i >> kBlockBits].load(std::memory_order_acquire)[i & (kBlock - 1)];
    }
    /// First of `count` new values that lie in one block (`count` divides the block's size). Throws
    /// std::bad_alloc when the arena is full.
    std::uint32_t add(std::uint32_t count) {
        const std::uint64_t first = used_.fetch_add(count, std::memory_order_relaxed);
        const std::uint64_t block = first >> kBlockBits;
        if (block >= kMostBlocks) throw std::bad_alloc();
        std::atomic<Value*>& place = (*blocks_)[block];
        if (place.load(std::memory_order_acquire) == nullptr) {
            auto fresh = std::make_unique<Value[]>(kBlock);
            Value* none = nullptr;
            if (place.compare_exchange_strong(none, fresh.get(), std::memory_order_acq_rel))
                (void)fresh.release();
        }
        return static_cast<std::uint32_t>(first);
    }
    [[nodiscard]] std::uint64_t size() const { return used_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::size_t memory_bytes() const {
        return (size() + kBlock - 1) / kBlock * kBlock * sizeof(Value);
    }

  private:
    std::unique_ptr<std::array<std::atomic<Value*>, kMostBlocks>> blocks_;
    std::atomic<std::uint64_t> used_{0};
};

/// Any number of threads may look up and insert at the same time. A lookup sees every record whose
/// insertion had ended before it began. Records stay until the cache goes.
class ConcurrentCache final : public AmbientCache {
  public:
    explicit ConcurrentCache(const AmbientLimits& limits);
    [[nodiscard]] const AmbientLimits& limits() const override { return limits_; }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override;
    void insert(const AmbientRecord& record) override;
    [[nodiscard]] AmbientLogMean log_mean() const override;
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return claims_.claim(query);
    }
    void release(const AmbientClaim& claim) override { claims_.release(claim); }
    [[nodiscard]] std::size_t open_claims() const { return claims_.open(); }
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    /// Of all records and nodes, used or set aside.
    [[nodiscard]] std::size_t memory_bytes() const {
        return records_.memory_bytes() + families_.memory_bytes();
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    static constexpr std::size_t kShards = 64;
    struct Node {
        std::atomic<std::uint32_t> children{0};   ///< family; 0: none
        std::atomic<std::uint32_t> first{kNone};  ///< record, newest first
        ReachBox reach;                           ///< of its records and its children's
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
    void sum_node(const Node& node, const CachePath& cube, const Search& search,
                  AmbientSum& sum) const;
    void sum_records(std::uint32_t first, const Search& search, AmbientSum& sum) const;

    AmbientLimits limits_;
    BlockArena<Family, 6> families_;  ///< the first child of the first is the root
    BlockArena<DecodedRecord, 8> records_;
    std::array<Shard, kShards> shards_;
    ClaimTable claims_;
};

}  // namespace lightwalk
