#include "parallel/ranks/topology.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace lightwalk {
namespace {

/// One master answers so many without becoming what they wait for: the scaling model in perf/.
constexpr int kMostChildren = 256;

int settled_masters(int masters, int ranks) {
    if (masters > 0) return masters;
    return ranks <= kMostChildren ? 1 : 1 + (ranks + kMostChildren - 1) / kMostChildren;
}

}  // namespace

std::optional<std::size_t> Topology::worker_index(int rank) const {
    const auto found = std::lower_bound(workers.begin(), workers.end(), rank,
                                        [](const Worker& w, int r) { return w.rank < r; });
    if (found == workers.end() || found->rank != rank) return std::nullopt;
    return static_cast<std::size_t>(found - workers.begin());
}

Topology make_topology(Variant variant, int ranks, bool ambient, int masters) {
    const int below = settled_masters(masters, ranks) - 1;  // masters below rank 0
    Topology topology;
    topology.ranks = ranks;
    if (ambient) topology.ambient_master = variant == Variant::ranks ? 1 : 0;
    // Ranks that do nothing but answer messages come first.
    const int silent = variant == Variant::ranks ? 1 + (ambient ? 1 : 0) + below : 0;
    const int least = variant == Variant::ranks ? silent + std::max(1, below) : below + 1;
    if (ranks < least) {
        throw InputError("this way of sharing the work needs at least " + std::to_string(least) +
                         " ranks, not " + std::to_string(ranks));
    }
    for (int rank = silent; rank < ranks; ++rank) topology.workers.push_back({rank, 0});
    if (below == 0) {
        for (const Topology::Worker& worker : topology.workers)
            topology.children.push_back({worker.rank, Role::worker});
        return topology;
    }
    // Groups of workers that stand side by side. In `hybrid` rank 0 keeps a group of its own, and
    // the others' masters are the first of their workers.
    const bool hybrid = variant == Variant::hybrid;
    const auto groups = static_cast<std::size_t>(hybrid ? below + 1 : below);
    const std::size_t count = topology.workers.size();
    for (std::size_t g = 0; g < groups; ++g) {
        const std::size_t begin = g * count / groups, end = (g + 1) * count / groups;
        std::vector<Address> children;
        for (std::size_t w = begin; w < end; ++w)
            children.push_back({topology.workers[w].rank, Role::worker});
        if (hybrid && g == 0) {
            topology.children = children;
            continue;
        }
        const int rank =
            hybrid ? topology.workers[begin].rank : 1 + (ambient ? 1 : 0) + static_cast<int>(g);
        for (std::size_t w = begin; w < end; ++w) topology.workers[w].master = rank;
        topology.sub_masters.push_back({rank, std::move(children)});
        topology.children.push_back({rank, Role::master});
    }
    return topology;
}

SubImages::SubImages(const PixelRectangle& area, std::size_t count) : area_(area), count_(count) {
    // Columns of about equal shape; the last ones may hold one rectangle more.
    const double aspect =
        static_cast<double>(std::max(1, area.width())) / std::max(1, area.height());
    const auto n = static_cast<double>(std::max<std::size_t>(1, count));
    columns_ = static_cast<std::size_t>(std::clamp(std::round(std::sqrt(n * aspect)), 1.0, n));
}

PixelRectangle SubImages::part(std::size_t column, std::size_t row) const {
    const auto cut = [](int from, int size, std::size_t i, std::size_t pieces) {
        return from +
               static_cast<int>(static_cast<std::int64_t>(size) * static_cast<std::int64_t>(i) /
                                static_cast<std::int64_t>(pieces));
    };
    // A column is as wide as its share of the rectangles.
    const std::size_t first = first_of(column), rows = first_of(column + 1) - first;
    return {cut(area_.x0, area_.width(), first, count_), cut(area_.y0, area_.height(), row, rows),
            cut(area_.x0, area_.width(), first + rows, count_),
            cut(area_.y0, area_.height(), row + 1, rows)};
}

PixelRectangle SubImages::operator[](std::size_t i) const {
    const std::size_t column = ((i + 1) * columns_ - 1) / count_;
    return part(column, i - first_of(column));
}

std::vector<std::size_t> SubImages::overlapping(const PixelRectangle& block) const {
    std::vector<std::size_t> found;
    // The first column, or row of a column, that ends beyond a place: their ends never decrease.
    const auto first_beyond = [](std::size_t count, int place, auto end_of) {
        std::size_t low = 0, high = count;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (end_of(middle) > place)
                high = middle;
            else
                low = middle + 1;
        }
        return low;
    };
    const std::size_t left =
        first_beyond(columns_, block.x0, [&](std::size_t c) { return part(c, 0).x1; });
    for (std::size_t c = left; c < columns_ && part(c, 0).x0 < block.x1; ++c) {
        const std::size_t first = first_of(c), rows = first_of(c + 1) - first;
        const std::size_t low =
            first_beyond(rows, block.y0, [&](std::size_t r) { return part(c, r).y1; });
        for (std::size_t r = low; r < rows && part(c, r).y0 < block.y1; ++r) {
            if (!part(c, r).empty()) found.push_back(first + r);
        }
    }
    return found;
}

}  // namespace lightwalk
