#include "core/ambient/serial_cache.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {

AmbientLimits ambient_limits(const Vec3& origin, double size, double accuracy, int resolution) {
    AmbientLimits limits{origin, size, accuracy, 10 * kEpsilon, size / 5};
    if (resolution > 0) {
        limits.least_radius = size / resolution;
        limits.most_radius = std::min(64 * limits.least_radius, size / 5);
    }
    if (limits.least_radius <= kEpsilon) limits.least_radius = 10 * kEpsilon;
    if (limits.most_radius <= limits.least_radius) limits.most_radius = 64 * limits.least_radius;
    return limits;
}

void SerialCache::insert(const AmbientRecord& record) {
    CachePath cube{limits_.origin, limits_.size};
    std::uint32_t at = 0;
    while (cube.edge / 2 > limits_.accuracy * static_cast<double>(record.radius[1])) {
        if (nodes_[at].children == 0) {
            const auto children = static_cast<std::uint32_t>(nodes_.size());
            nodes_.resize(nodes_.size() + 8);
            nodes_[at].children = children;
        }
        at = nodes_[at].children + descend(cube, record.position);
    }
    std::uint32_t* link = &nodes_[at].first;
    while (*link != kNone) {
        DecodedRecord& other = records_[*link];
        if (other.level > record.level ||
            (other.level == record.level && other.weight <= record.weight))
            break;
        link = &other.next;
    }
    DecodedRecord decoded(record);
    decoded.next = *link;
    *link = static_cast<std::uint32_t>(records_.size());
    records_.push_back(decoded);
    const auto bright = static_cast<double>(brightness(record.value));
    if (bright <= kEpsilon) return;
    ++log_mean_.count;
    log_mean_.sum += std::log(bright);
}

AmbientSum SerialCache::lookup(const AmbientQuery& query, LeakTest leaks) const {
    AmbientSum sum;
    sum_node(nodes_[0], {limits_.origin, limits_.size}, query, leaks, sum);
    return sum;
}

void SerialCache::sum_node(const Node& node, const CachePath& cube, const AmbientQuery& query,
                           LeakTest leaks, AmbientSum& sum) const {
    AmbientSum own;
    if (node.children != 0) {
        for (unsigned child = 0; child < 8; ++child) {
            const CachePath inside = child_cube(cube, child);
            if (reaches(inside, query.position))
                sum_node(nodes_[node.children + child], inside, query, leaks, own);
        }
    }
    const bool enough = node.children != 0 && own.weight >= kEnoughWeight &&
                        cube.edge * 0.5 * limits_.accuracy > limits_.least_radius;
    if (!enough) sum_records(node, query, leaks, own);
    sum.weight += own.weight;
    for (std::size_t k = 0; k < 3; ++k) sum.sum[k] += own.sum[k];
}

void SerialCache::sum_records(const Node& node, const AmbientQuery& query, LeakTest leaks,
                              AmbientSum& sum) const {
    if (node.first == kNone) return;
    const double angle =
        largest_angle(limits_.accuracy, query.weight, records_[node.first].level <= query.level);
    for (std::uint32_t i = node.first; i != kNone && records_[i].serves(query.level, query.weight);
         i = records_[i].next) {
        add_record(records_[i], query, limits_, angle, leaks, sum);
    }
}

}  // namespace lightwalk
