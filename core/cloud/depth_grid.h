#pragma once
// The z-buffer of the cloud: which point each pixel of a picture gets.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "core/cloud/point.h"
#include "core/math/prefetch.h"
#include "core/view/pixels.h"

namespace lightwalk {

inline constexpr std::uint32_t kNoPoint = ~std::uint32_t{0};

/// A grid with one cell for each pixel. A cell keeps the nearest of the points offered to it; of
/// those about equally near (within 0.8 %) the one closest to the pixel's centre; of those the
/// first in an order given by the caller. The result is independent of the order of offers; many
/// threads may offer at once (lock-free), while none reads.
class DepthGrid {
  public:
    /// A grid whose cells are empty.
    explicit DepthGrid(const PixelRectangle& area)
        : area_(area), cells_(area.pixels()), keys_(std::make_unique<std::uint64_t[]>(cells_)) {
        clear(0, cells_);
    }

    [[nodiscard]] std::size_t size() const { return cells_; }
    [[nodiscard]] const PixelRectangle& area() const { return area_; }
    /// Empty the cells first ... last - 1, row by row from the bottom.
    void clear(std::size_t first, std::size_t last) {
        std::fill(&keys_[first], &keys_[first] + (last - first), kEmpty);
    }

    /// Offer a point to a cell. @param x,y       the pixel, inside the area
    /// @param distance  > 0 [m]
    /// @param apart     from the pixel's centre, 0 ... 1 [pixels]
    /// @param first     first(a, b): whether index a is preferred to index b
    template <class First = std::less<std::uint32_t>>
    void offer(int x, int y, float distance, float apart, std::uint32_t index, First first = {}) {
        const std::uint64_t key = pack(distance, apart, index);
        const std::atomic_ref<std::uint64_t> cell(keys_[at(x, y)]);
        std::uint64_t kept = cell.load(std::memory_order_relaxed);
        while (wins(key, kept, first) &&
               !cell.compare_exchange_weak(kept, key, std::memory_order_relaxed)) {
        }
    }

    /// Fetch a cell into the cache, for an offer soon.
    [[gnu::always_inline]] void prefetch(int x, int y) const {
        lightwalk::prefetch(&keys_[at(x, y)]);
    }

    /// The index of the point that a cell holds; kNoPoint where it is empty.
    [[nodiscard]] std::uint32_t winner(int x, int y) const {
        return static_cast<std::uint32_t>(keys_[at(x, y)]);
    }

    /// Statistics of each 3 x 3 neighbourhood of cells, for a square of pixels, row by row.
    struct Surroundings {
        static constexpr int kSide = 8;
        std::array<std::uint16_t, std::size_t{kSide} * kSide>
            known;  ///< number of cells that are not empty
        /// Largest difference of their depths [steps of .4 to .8 %].
        std::array<std::uint16_t, std::size_t{kSide} * kSide> spread;
    };
    /// Statistics of the neighbourhoods in a square. Cheap: needs the cells only, not the points.
    /// @param corner  the square's lower left pixel; parts of it may lie outside
    [[nodiscard]] Surroundings surroundings(const PixelPlace& corner) const;
    /// Difference of depth, about a tenth, from which a cell counts as lying in front of another
    /// one [steps of .4 to .8 %].
    static constexpr int kBehind = 16;
    /// Whether most of the non-empty cells around a pixel lie in front of its own. Needs the cells
    /// only.
    [[nodiscard]] bool is_behind(int x, int y) const;
    /// Whether all cells of the square, and those adjacent to it, are empty. Needs the cells only.
    [[nodiscard]] bool is_empty(const PixelPlace& corner) const;

  private:
    static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
    static constexpr int kDepthShift = 48;
    static constexpr std::uint16_t kNoDepth = 0xffff;
    template <class First>
    [[nodiscard]] static bool wins(std::uint64_t key, std::uint64_t kept, First first) {
        if (key >> 32 != kept >> 32) return key < kept;
        return first(static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(kept));
    }
    [[nodiscard]] static std::uint64_t pack(float distance, float apart, std::uint32_t index) {
        // Floats that are not negative are ordered as their bits are: 8 of exponent, 7 of mantissa.
        const std::uint64_t depth = std::bit_cast<std::uint32_t>(distance) >> 16;
        const auto off = static_cast<std::uint64_t>(apart * 65535.0f);
        return depth << kDepthShift | off << 32 | index;
    }
    [[nodiscard]] std::size_t at(int x, int y) const { return area_.index({x, y}); }

    PixelRectangle area_;
    std::size_t cells_;
    std::unique_ptr<std::uint64_t[]> keys_;
};

inline bool DepthGrid::is_behind(int x, int y) const {
    const auto depth = [&](int u, int v) {
        return static_cast<int>(keys_[at(u, v)] >> kDepthShift);
    };
    const int own = depth(x, y);
    int known = 0, before = 0;
    for (int v = std::max(y - 1, area_.y0); v < std::min(y + 2, area_.y1); ++v) {
        for (int u = std::max(x - 1, area_.x0); u < std::min(x + 2, area_.x1); ++u) {
            const int other = depth(u, v);
            if (other == kNoDepth || (u == x && v == y)) continue;
            ++known;
            if (other < own - kBehind) ++before;
        }
    }
    return 2 * before > known;
}

inline bool DepthGrid::is_empty(const PixelPlace& corner) const {
    constexpr int kSide = Surroundings::kSide;
    const int x0 = std::max(corner.x - 1, area_.x0), y0 = std::max(corner.y - 1, area_.y0);
    const int x1 = std::min(corner.x + kSide + 1, area_.x1);
    const int y1 = std::min(corner.y + kSide + 1, area_.y1);
    std::uint64_t all = kEmpty;
    for (int y = y0; y < y1 && all == kEmpty; ++y) {
        const std::uint64_t* const row = &keys_[at(x0, y)];
        for (int x = 0; x < x1 - x0; ++x) all &= row[x];
    }
    return all == kEmpty;
}

inline DepthGrid::Surroundings DepthGrid::surroundings(const PixelPlace& corner) const {
    constexpr int kSide = Surroundings::kSide, kWide = kSide + 2;
    std::array<std::uint16_t, std::size_t{kWide} * kWide> depths;
    const auto depth = [](std::uint64_t key) {
        return static_cast<std::uint16_t>(key >> kDepthShift);
    };
    const PixelPlace first{corner.x - 1, corner.y - 1}, last{corner.x + kSide, corner.y + kSide};
    std::uint16_t* next = depths.data();
    if (area_.contains(first) && area_.contains(last)) {
        for (int y = 0; y < kWide; ++y, next += kWide) {
            const std::uint64_t* const row = &keys_[at(first.x, first.y + y)];
            for (int x = 0; x < kWide; ++x) next[x] = depth(row[x]);
        }
    } else {
        for (int y = 0; y < kWide; ++y) {
            for (int x = 0; x < kWide; ++x) {
                const PixelPlace place{first.x + x, first.y + y};
                *next++ = area_.contains(place) ? depth(keys_[at(place.x, place.y)]) : kNoDepth;
            }
        }
    }
    Surroundings found;
    for (std::size_t y = 0; y < kSide; ++y) {
        std::array<std::uint16_t, kWide> known, nearest,
            farthest;  // of three cells one above other
        for (std::size_t x = 0; x < kWide; ++x) {
            const std::uint16_t a = depths[y * kWide + x], b = depths[(y + 1) * kWide + x],
                                c = depths[(y + 2) * kWide + x];
            known[x] =
                static_cast<std::uint16_t>((a != kNoDepth) + (b != kNoDepth) + (c != kNoDepth));
            nearest[x] = std::min({a, b, c});
            // One more than it is, so that empty cells, the deepest, overflow to the least.
            farthest[x] =
                std::max({static_cast<std::uint16_t>(a + 1), static_cast<std::uint16_t>(b + 1),
                          static_cast<std::uint16_t>(c + 1)});
        }
        for (std::size_t x = 0; x < kSide; ++x) {
            const std::uint16_t least = std::min({nearest[x], nearest[x + 1], nearest[x + 2]});
            const std::uint16_t most = std::max({farthest[x], farthest[x + 1], farthest[x + 2]});
            found.known[y * kSide + x] =
                static_cast<std::uint16_t>(known[x] + known[x + 1] + known[x + 2]);
            found.spread[y * kSide + x] = static_cast<std::uint16_t>(most - 1 - least);
        }
    }
    return found;
}

/// Separate grids for points seen directly and for points seen in mirrors: these lie behind the
/// mirror, and would lose against its own points.
struct CloudGrids {
    explicit CloudGrids(const PixelRectangle& area) : ahead(area), mirrored(area) {}
    /// The grid for points of a kind.
    [[nodiscard]] DepthGrid& of(PointKind kind) {
        return kind == PointKind::mirrored ? mirrored : ahead;
    }

    DepthGrid ahead, mirrored;
};

}  // namespace lightwalk
