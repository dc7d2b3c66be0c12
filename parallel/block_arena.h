#pragma once
// An arena of values that many threads add and read concurrently.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace lightwalk {

/// Values in blocks that never move, by index. Blocks are made when they are first needed, and so
/// is the directory that leads to them, which grows by copies; all are freed with the arena.
/// Reading takes no lock; adding takes one when it needs a new block. Who reads a value must have
/// got its index from the thread that added it, by an acquiring load of what that thread released.
template <class Value, unsigned kBlockBits>
class BlockArena {
  public:
    static constexpr std::uint32_t kBlock = 1U << kBlockBits;
    static constexpr std::size_t kMostBlocks = std::size_t{1} << 16;

    [[nodiscard]] Value& operator[](std::uint32_t i) const {
        return directory_.load(std::memory_order_acquire)[i >> kBlockBits].load(
            std::memory_order_acquire)[i & (kBlock - 1)];
    }
    /// Index of a new value. Throws std::bad_alloc when the arena is full.
    std::uint32_t add() {
        const std::uint64_t i = used_.fetch_add(1, std::memory_order_relaxed);
        const std::uint64_t block = i >> kBlockBits;
        if (block >= kMostBlocks) throw std::bad_alloc();
        if (block >= places_.load(std::memory_order_acquire) ||
            directory_.load(std::memory_order_acquire)[block].load(std::memory_order_acquire) ==
                nullptr)
            make_block(static_cast<std::size_t>(block));
        return static_cast<std::uint32_t>(i);
    }
    /// Value i, of an arena whose indices are those of another one: none are added. Values are made
    /// with their block.
    [[nodiscard]] Value& at(std::uint32_t i) {
        const std::size_t block = i >> kBlockBits;
        if (block >= places_.load(std::memory_order_acquire) ||
            directory_.load(std::memory_order_acquire)[block].load(std::memory_order_acquire) ==
                nullptr)
            make_block(block);
        return (*this)[i];
    }
    [[nodiscard]] std::uint64_t size() const { return used_.load(std::memory_order_relaxed); }
    /// Bytes of all blocks and directories, without the arena object.
    [[nodiscard]] std::size_t memory_bytes() const {
        return memory_bytes_.load(std::memory_order_relaxed);
    }

  private:
    using Place = std::atomic<Value*>;

    void make_block(std::size_t block) {
        const std::lock_guard lock(making_);
        if (block >= places_.load(std::memory_order_relaxed)) grow(block + 1);
        Place& place = directory_.load(std::memory_order_relaxed)[block];
        if (place.load(std::memory_order_relaxed) != nullptr) return;  // another thread was faster
        blocks_.push_back(std::make_unique<Value[]>(kBlock));
        memory_bytes_.fetch_add(kBlock * sizeof(Value) + 2 * sizeof(blocks_[0]),
                                std::memory_order_relaxed);
        place.store(blocks_.back().get(), std::memory_order_release);
    }
    /// The old directory is kept, as readers may still use it.
    void grow(std::size_t least) {
        const std::size_t old = places_.load(std::memory_order_relaxed);
        const std::size_t places = std::max({least, 2 * old, std::size_t{8}});
        auto fresh = std::make_unique<Place[]>(places);
        const Place* const before = directory_.load(std::memory_order_relaxed);
        for (std::size_t i = 0; i < old; ++i)
            fresh[i].store(before[i].load(std::memory_order_relaxed), std::memory_order_relaxed);
        directories_.push_back(std::move(fresh));
        memory_bytes_.fetch_add(places * sizeof(Place), std::memory_order_relaxed);
        directory_.store(directories_.back().get(), std::memory_order_release);
        places_.store(places, std::memory_order_release);
    }

    std::atomic<Place*> directory_{nullptr};  ///< the newest of directories_
    std::atomic<std::size_t> places_{0};      ///< number of entries in it
    std::atomic<std::uint64_t> used_{0};
    std::atomic<std::size_t> memory_bytes_{0};
    std::mutex making_;
    std::vector<std::unique_ptr<Place[]>> directories_;  ///< each twice as large as the one before
    std::vector<std::unique_ptr<Value[]>> blocks_;       ///< in the order of their making
};

}  // namespace lightwalk
