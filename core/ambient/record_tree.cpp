#include "core/ambient/record_tree.h"

#include <algorithm>

namespace lightwalk {

struct RecordTree::Search {
    const AmbientQuery& query;
    LeakTest leaks;
    double angle;             ///< largest between normals
    std::array<float, 3> at;  ///< the query's place
    std::vector<RecordShare>& shares;
};

void RecordTree::Box::grow(const Box& other) {
    const bool empty = low[0] > high[0];
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = empty ? other.low[k] : std::min(low[k], other.low[k]);
        high[k] = empty ? other.high[k] : std::max(high[k], other.high[k]);
    }
}

void RecordTree::insert(const AmbientRecord& record) {
    const auto number = static_cast<std::uint32_t>(records_.size());
    DecodedRecord& decoded = records_.emplace_back(record);
    const RecordReach reach = reach_of(decoded, limits_);
    Leaf& leaf = leaves_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
        leaf.box.low[k] = static_cast<float>(reach.low[k]);
        leaf.box.high[k] = static_cast<float>(reach.high[k]);
    }
    CachePath cube{limits_.origin, limits_.size};
    std::uint32_t at = 0;
    while (cube.edge / 2 > limits_.accuracy * static_cast<double>(record.radius[1])) {
        if (nodes_[at].children == 0) {
            const auto children = static_cast<std::uint32_t>(nodes_.size());
            nodes_.resize(nodes_.size() + 8);
            nodes_[at].children = children;
        }
        at = nodes_[at].children + descend(cube, record.position);
        nodes_[at].box.grow(leaf.box);
    }
    leaf.next = nodes_[at].first;
    nodes_[at].first = number;
}

double RecordTree::find(const AmbientQuery& query, LeakTest leaks,
                        std::vector<RecordShare>& shares) const {
    const Vec3& p = query.position;
    return find_below(nodes_[0], limits_.size,
                      {query,
                       leaks,
                       largest_angle(limits_.accuracy, query.weight, true),
                       {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                       shares});
}

/// @param edge  of the node's cube [m]
double RecordTree::find_below(const Node& node, double edge, const Search& search) const {
    double weight = 0;
    if (node.children != 0) {
        for (std::uint32_t child = 0; child < 8; ++child) {
            const Node& inside = nodes_[node.children + child];
            if (inside.box.holds(search.at)) weight += find_below(inside, 0.5 * edge, search);
        }
        if (weight >= kEnoughWeight && edge * 0.5 * limits_.accuracy > limits_.least_radius)
            return weight;
    }
    for (std::uint32_t i = node.first; i != kNone; i = leaves_[i].next) {
        if (!leaves_[i].box.holds(search.at)) continue;
        const DecodedRecord& record = records_[i];
        if (!record.serves(search.query.level, search.query.weight)) continue;
        const RecordUse use = use_of(record, search.query, limits_, search.angle, search.leaks);
        if (use.weight <= 0) continue;
        weight += use.weight;
        search.shares.push_back({i, use.weight, use.factor});
    }
    return weight;
}

}  // namespace lightwalk
