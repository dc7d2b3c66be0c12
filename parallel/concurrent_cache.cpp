#include "parallel/concurrent_cache.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace lightwalk {

ConcurrentCache::ConcurrentCache(const AmbientLimits& limits)
    : limits_(limits), claims_(limits.accuracy * limits.least_radius) {
    (void)families_.add();
}

/// The family of children of a node, created where it is missing. When two threads create it at
/// once, one of the two stays unused.
std::uint32_t ConcurrentCache::children_of(Node& node) {
    std::uint32_t children = node.children.load(std::memory_order_acquire);
    if (children != 0) return children;
    const std::uint32_t fresh = families_.add();
    return node.children.compare_exchange_strong(children, fresh, std::memory_order_acq_rel)
               ? fresh
               : children;
}

void ConcurrentCache::insert_with_groups(const AmbientRecord& record, std::span<const Rgb> groups) {
    const std::uint32_t place = records_.add();
    DecodedRecord& decoded = records_[place];
    decoded = DecodedRecord(record);
    if (!groups.empty()) {
        std::unique_ptr<Rgb[]>& kept = groups_.at(place);
        kept = std::make_unique<Rgb[]>(groups.size());
        std::copy(groups.begin(), groups.end(), kept.get());
    }
    const auto [low, high] = reach_of(decoded, limits_);
    CachePath cube{limits_.origin, limits_.size};
    Node* at = &families_[0].child[0];
    std::uint32_t family = 0;
    while (cube.edge / 2 > limits_.accuracy * static_cast<double>(record.radius[1])) {
        family = children_of(*at);
        at = &families_[family].child[descend(cube, record.position)];
        at->reach.grow(ReachGrid(cube), low, high);
    }
    const auto bright = static_cast<double>(brightness(record.value));
    Shard& shard = shards_[family % kShards];
    const std::lock_guard lock(shard.mutex);
    decoded.next = at->first.load(std::memory_order_relaxed);
    at->first.store(place, std::memory_order_release);
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

/// The state of a lookup in the tree.
struct ConcurrentCache::Search {
    const AmbientQuery& query;
    LeakTest leaks;
    double angle;                             ///< largest between normals
    std::span<std::array<double, 3>> groups;  ///< sums of what each adds; empty: not asked for
};

AmbientSum ConcurrentCache::lookup(const AmbientQuery& query, LeakTest leaks) const {
    return sum_all({query, leaks, largest_angle(limits_.accuracy, query.weight, true), {}});
}

AmbientSum ConcurrentCache::lookup_groups(const AmbientQuery& query, LeakTest leaks,
                                          std::span<std::array<double, 3>> groups) const {
    return sum_all({query, leaks, largest_angle(limits_.accuracy, query.weight, true), groups});
}

AmbientSum ConcurrentCache::sum_all(const Search& search) const {
    AmbientSum sum;
    sum_node(families_[0].child[0], {limits_.origin, limits_.size}, search, sum);
    return sum;
}

/// Calls visit(child, cube) for the children whose records may be usable at a point.
template <class Visit>
void ConcurrentCache::for_reaching(const Family& family, const CachePath& parent, const Vec3& p,
                                   Visit visit) {
    std::array<std::array<std::uint64_t, 2>, 3> steps{};  // in each axis, of either half
    unsigned mask = 0xff;
    constexpr std::array<std::array<unsigned, 2>, 3> kSides{
        {{0x55, 0xaa}, {0x33, 0xcc}, {0x0f, 0xf0}}};
    const ReachGrid low(child_cube(parent, 0)), high(child_cube(parent, 7));
    const double edge = 0.5 * parent.edge;
    for (std::size_t k = 0; k < 3; ++k) {
        const double at = p[k] - parent.corner[k];
        mask &= (at >= -edge && at <= 2 * edge ? kSides[k][0] : 0) |
                (at >= 0 && at <= 3 * edge ? kSides[k][1] : 0);
        steps[k] = {low.step(k, p[k]), high.step(k, p[k])};
    }
    for (; mask != 0; mask &= mask - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(mask));
        const Node& child = family.child[i];
        if (child.reach.holds(
                ReachBox::place(steps[0][i & 1], steps[1][i >> 1 & 1], steps[2][i >> 2])))
            visit(child, child_cube(parent, i));
    }
}

void ConcurrentCache::sum_node(const Node& node, const CachePath& cube, const Search& search,
                               AmbientSum& sum) const {
    const std::uint32_t children = node.children.load(std::memory_order_acquire);
    AmbientSum own;
    if (children != 0) {
        for_reaching(families_[children], cube, search.query.position,
                     [&](const Node& child, const CachePath& inside) {
                         sum_node(child, inside, search, own);
                     });
    }
    const bool enough = children != 0 && own.weight >= kEnoughWeight &&
                        cube.edge * 0.5 * limits_.accuracy > limits_.least_radius;
    if (!enough) sum_records(node.first.load(std::memory_order_acquire), search, own);
    sum.weight += own.weight;
    for (std::size_t k = 0; k < 3; ++k) sum.sum[k] += own.sum[k];
}

/// The serial cache sorts records by level and weight and stops at the first that is not usable;
/// here each is tested.
void ConcurrentCache::sum_records(std::uint32_t first, const Search& search,
                                  AmbientSum& sum) const {
    const AmbientQuery& query = search.query;
    for (std::uint32_t i = first; i != kNone; i = records_[i].next) {
        const DecodedRecord& record = records_[i];
        if (!record.serves(query.level, query.weight)) continue;
        if (search.groups.empty())
            add_record(record, query, limits_, search.angle, search.leaks, sum);
        else
            add_groups(i, search, sum);
    }
}

/// Of each group what add_record() adds of the record's value.
void ConcurrentCache::add_groups(std::uint32_t number, const Search& search,
                                 AmbientSum& sum) const {
    const DecodedRecord& record = records_[number];
    const RecordUse use = use_of(record, search.query, limits_, search.angle, search.leaks);
    if (use.weight <= 0) return;
    sum.weight += use.weight;
    for (std::size_t k = 0; k < 3; ++k)
        sum.sum[k] += use.weight * use.factor * static_cast<double>(record.value[k]);
    const Rgb* values = groups_[number].get();
    for (std::size_t g = 0; g < search.groups.size(); ++g) {
        for (std::size_t k = 0; k < 3; ++k)
            search.groups[g][k] += use.weight * use.factor * static_cast<double>(values[g][k]);
    }
}

}  // namespace lightwalk
