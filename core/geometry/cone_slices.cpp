#include "core/geometry/cone_slices.h"

namespace lightwalk {
namespace {

constexpr int kMostSlices = 16;
constexpr double kWorthHalving =
    0.75;  ///< halving is worth it where at most this share of the boxes' area is left

}  // namespace

ConeSlices slices_of(const ConeShape& cone, double least) {
    ConeSlices slices;
    const double whole = half_area(hit_bounds(cone, 0, 1));
    if (whole <= least) return slices;
    double area = whole;
    while (slices.count < kMostSlices) {
        double halved = 0;
        for (int i = 0; i < 2 * slices.count; ++i)
            halved += half_area(hit_bounds(cone, i, 2 * slices.count));
        if (halved > kWorthHalving * area || whole - halved <= least) break;
        slices = {2 * slices.count, whole - halved};
        area = halved;
    }
    return slices;
}

Bounds hit_bounds(const ConeShape& cone, int i, int count) {
    ConeShape slice = cone;
    const auto at = [&](int end) { return cone.length * end / count; };
    if (i > 0) {
        slice.p0 = cone.p0 + cone.axis * at(i);
        slice.r0 = cone.r0 + cone.slope * at(i);
    }
    if (i + 1 < count) {
        slice.p1 = cone.p0 + cone.axis * at(i + 1);
        slice.r1 = cone.r0 + cone.slope * at(i + 1);
    }
    return hit_bounds(slice);
}

}  // namespace lightwalk
