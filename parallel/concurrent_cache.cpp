#include "parallel/concurrent_cache.h"

#include <bit>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kEnough = 0.05;  ///< weight of small records that keeps larger ones out

}  // namespace

ConcurrentCache::ConcurrentCache(const AmbientLimits& limits)
    : limits_(limits), claims_(limits.accuracy * limits.least_radius) {
    (void)nodes_.add(
        8);  // the root, and seven that nobody uses: eight children never straddle blocks
}

/// First child; made where it is missing. Who comes second leaves eight nodes unused.
std::uint32_t ConcurrentCache::children_of(std::uint32_t node) {
    std::atomic<std::uint32_t>& place = nodes_[node].children;
    std::uint32_t children = place.load(std::memory_order_acquire);
    if (children != 0) return children;
    const std::uint32_t fresh = nodes_.add(8);
    return place.compare_exchange_strong(children, fresh, std::memory_order_acq_rel) ? fresh
                                                                                     : children;
}

void ConcurrentCache::insert(const AmbientRecord& record) {
    CachePath cube{limits_.origin, limits_.size};
    std::uint32_t at = 0;
    while (cube.edge / 2 > limits_.accuracy * static_cast<double>(record.radius[1])) {
        at = children_of(at) + descend(cube, record.position);
    }
    const std::uint32_t place = records_.add(1);
    DecodedRecord& decoded = records_[place];
    decoded = DecodedRecord(record);
    const auto bright = static_cast<double>(brightness(record.value));
    Shard& shard = shards_[at % kShards];
    const std::lock_guard lock(shard.mutex);
    decoded.next = nodes_[at].first.load(std::memory_order_relaxed);
    nodes_[at].first.store(place, std::memory_order_release);
    if (bright <= kEpsilon) return;
    ++shard.log_mean.count;
    shard.log_mean.sum += std::log(bright);
}

AmbientLogMean ConcurrentCache::log_mean() const {
    AmbientLogMean all;
    for (const Shard& shard : shards_) {
        const std::lock_guard lock(shard.mutex);
        all.count += shard.log_mean.count;
        all.sum += shard.log_mean.sum;
    }
    return all;
}

/// A lookup on its way through the tree.
struct ConcurrentCache::Search {
    const AmbientQuery& query;
    LeakTest leaks;
    double angle;  ///< largest between normals
};

AmbientSum ConcurrentCache::lookup(const AmbientQuery& query, LeakTest leaks) const {
    const Search search{query, leaks, largest_angle(limits_.accuracy, query.weight, true)};
    AmbientSum sum;
    sum_node(nodes_[0], {limits_.origin, limits_.size}, search, sum);
    return sum;
}

/// Children whose records can reach a point, a bit each: it lies within their cube grown by its
/// edge.
unsigned ConcurrentCache::reaching_children(const CachePath& cube, const Vec3& p) {
    constexpr std::array<std::array<unsigned, 2>, 3> kSides{
        {{0x55, 0xaa}, {0x33, 0xcc}, {0x0f, 0xf0}}};
    const double edge = 0.5 * cube.edge;
    unsigned mask = 0xff;
    for (std::size_t k = 0; k < 3; ++k) {
        const double at = p[k] - cube.corner[k];
        mask &= (at >= -edge && at <= 2 * edge ? kSides[k][0] : 0) |
                (at >= 0 && at <= 3 * edge ? kSides[k][1] : 0);
    }
    return mask;
}

void ConcurrentCache::sum_node(const Node& node, const CachePath& cube, const Search& search,
                               AmbientSum& sum) const {
    const std::uint32_t children = node.children.load(std::memory_order_acquire);
    AmbientSum own;
    if (children != 0) {
        const Node* child = &nodes_[children];  // eight, in one block
        for (unsigned left = reaching_children(cube, search.query.position); left != 0;
             left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            const Node& n = child[i];
            if (n.first.load(std::memory_order_relaxed) == kNone &&
                n.children.load(std::memory_order_relaxed) == 0)
                continue;
            sum_node(n, child_cube(cube, i), search, own);
        }
    }
    const bool enough = children != 0 && own.weight >= kEnough &&
                        cube.edge * 0.5 * limits_.accuracy > limits_.least_radius;
    if (!enough) sum_records(node.first.load(std::memory_order_acquire), search, own);
    sum.weight += own.weight;
    for (std::size_t k = 0; k < 3; ++k) sum.sum[k] += own.sum[k];
}

/// The serial cache sorts by level and weight and stops at the first record that cannot serve; here
/// each is asked.
void ConcurrentCache::sum_records(std::uint32_t first, const Search& search,
                                  AmbientSum& sum) const {
    if (first == kNone) return;
    const AmbientQuery& query = search.query;
    bool has_level = false;
    for (std::uint32_t i = first; i != kNone && !has_level; i = records_[i].next) {
        has_level = records_[i].level <= query.level;
    }
    if (!has_level) return;
    for (std::uint32_t i = first; i != kNone; i = records_[i].next) {
        const DecodedRecord& record = records_[i];
        if (record.serves(query.level, query.weight))
            add_record(record, query, limits_, search.angle, search.leaks, sum);
    }
}

}  // namespace lightwalk
