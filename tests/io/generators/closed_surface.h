#pragma once
// Checks of surfaces that enclose a volume.
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/model/primitive.h"
#include "tests/io/generators/generated.h"

namespace lightwalk::test {

using Polygons = std::vector<std::vector<Vec3>>;

inline Polygons polygons(const Generated& generated) {
    Polygons result;
    for (const PrimitiveText& primitive : generated.primitives) {
        if (primitive.type != PrimitiveType::polygon) continue;
        result.emplace_back();
        for (std::size_t i = 0; i < primitive.reals.size() / 3; ++i) {
            result.back().push_back(vertex(primitive, i));
        }
    }
    return result;
}

/// The enclosed volume by the divergence theorem; positive when the normals point outward.
inline double enclosed_volume(const Polygons& polygons) {
    double volume = 0;
    for (const std::vector<Vec3>& p : polygons) {
        for (std::size_t i = 1; i + 1 < p.size(); ++i)
            volume += dot(p[0], cross(p[i], p[i + 1])) / 6;
    }
    return volume;
}

/// Whether every edge belongs to two polygons that traverse it in opposite directions. Points
/// nearer to each other than a millionth count as equal.
inline bool is_closed(const Polygons& polygons) {
    using Key = std::array<long long, 3>;
    const auto key = [](const Vec3& p) {
        return Key{std::llround(p.x * 1e6), std::llround(p.y * 1e6), std::llround(p.z * 1e6)};
    };
    std::map<std::pair<Key, Key>, int> balance;
    for (const std::vector<Vec3>& p : polygons) {
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Key a = key(p[i]);
            const Key b = key(p[(i + 1) % p.size()]);
            if (a == b) return false;
            if (a < b)
                ++balance[{a, b}];
            else
                --balance[{b, a}];
        }
    }
    for (const auto& [edge, sum] : balance) {
        if (sum != 0) return false;
    }
    return !balance.empty();
}

}  // namespace lightwalk::test
