#pragma once
// Positions in a unit square to swap unwanted ones for, so that all that are used stay uniform.
#include <array>
#include <cstddef>
#include <vector>

#include "core/math/random.h"

namespace lightwalk {

struct SquarePosition {
    double along_i = 0, along_j = 0;  ///< in [0, 1)
};

/// Swapping keeps the distribution: an unwanted position waits here for another cell. Those from
/// corners do not go back to corners, where neighbours collide.
class PositionPool {
  public:
    explicit PositionPool(RandomStream random) : random_(random) {}

    /// Another position for `unwanted`.
    SquarePosition trade(const SquarePosition& unwanted) {
        if (members_.empty()) refill();
        const std::size_t from = corner_of(unwanted);
        std::size_t choice = choose(from);
        if (choice == kSize) {
            refill();
            choice = choose(from);
        }
        const SquarePosition taken = members_[choice].position;
        --count_[members_[choice].corner];
        members_[choice] = {unwanted, from};
        ++count_[from];
        return taken;
    }

  private:
    static constexpr std::size_t kSize = 512, kNoCorner = 4, kManyCorners = 128;
    struct Member {
        SquarePosition position;
        std::size_t corner = kNoCorner;
    };

    static std::size_t corner_of(const SquarePosition& s) {
        const bool low_i = s.along_i<0.2, high_i = s.along_i> 0.8,
                   low_j = s.along_j<0.2, high_j = s.along_j> 0.8;
        if (!(low_i || high_i) || !(low_j || high_j)) return kNoCorner;
        return (high_i ? 1U : 0U) + (high_j ? 2U : 0U);
    }
    void refill() {
        members_.resize(kSize);
        for (Member& member : members_) member = {{random_.next(), random_.next()}, kNoCorner};
        count_ = {0, 0, 0, 0, kSize};
    }
    /// A member for a position of this corner; kSize: none.
    std::size_t choose(std::size_t from) {
        const std::size_t in_corners = kSize - count_[kNoCorner];
        if (from == kNoCorner) {
            if (in_corners <= kManyCorners) return static_cast<std::size_t>(random_.next() * kSize);
            return pick(in_corners, [](std::size_t corner) { return corner != kNoCorner; });
        }
        return pick(kSize - count_[from], [from](std::size_t corner) { return corner != from; });
    }
    template <class Wanted>
    std::size_t pick(std::size_t candidates, const Wanted& wanted) {
        if (candidates == 0) return kSize;
        auto skip = static_cast<std::size_t>(random_.next() * static_cast<double>(candidates));
        for (std::size_t k = 0; k < kSize; ++k) {
            if (wanted(members_[k].corner) && skip-- == 0) return k;
        }
        return kSize;
    }

    RandomStream random_;
    std::vector<Member> members_;
    std::array<std::size_t, 5> count_{};
};

}  // namespace lightwalk
