#include "core/texture/interpolate.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lightwalk {
namespace {

constexpr std::size_t kMaxAxes = 6;

/// The two neighbours of a coordinate, `first` and `first + 1`, and what each counts.
struct Neighbours {
    std::size_t first = 0;
    double weight0 = 1, weight1 = 0;
};

/// Segment of an irregular axis that holds t; the first or last when t is outside.
std::size_t segment_of(const std::vector<float>& points, double t) {
    const auto first = points.begin() + 1, last = points.end() - 1;
    const bool ascending = points.front() < points.back();
    const auto next =
        ascending ? std::upper_bound(first, last, t,
                                     [](double x, float p) { return x < static_cast<double>(p); })
                  : std::upper_bound(first, last, t,
                                     [](double x, float p) { return x > static_cast<double>(p); });
    return static_cast<std::size_t>(next - first);
}

/// Position of t on the axis, counted in points, and the segment it belongs to.
double index_of(const DataArray::Axis& axis, double t, std::size_t& segment) {
    const std::size_t last = axis.count - 2;
    if (axis.points.empty()) {
        const double x = (t - static_cast<double>(axis.origin)) / static_cast<double>(axis.extent) *
                         static_cast<double>(axis.count - 1);
        segment = x >= 1 && x < 0x1p31 ? std::min(static_cast<std::size_t>(x), last) : 0;
        return x;
    }
    segment = segment_of(axis.points, t);
    const auto p0 = static_cast<double>(axis.points[segment]);
    const double step = static_cast<double>(axis.points[segment + 1]) - p0;
    if (step == 0) return static_cast<double>(segment);  // repeated point of a falling axis
    return static_cast<double>(segment) + (t - p0) / step;
}

Neighbours neighbours(const DataArray::Axis& axis, double t) {
    if (axis.count < 2) return {};
    Neighbours at;
    const double x = index_of(axis, t, at.first);
    const auto i = static_cast<double>(at.first);
    if (x > i + 2) {
        at.weight0 = 1 / (i - 1 - x);
        at.weight1 = -2 * at.weight0;
    } else if (x < i - 1) {
        at.weight1 = 1 / (x - i);
        at.weight0 = -2 * at.weight1;
    } else {
        at.weight0 = i + 1 - x;
        at.weight1 = x - i;
    }
    return at;
}

/// Outer neighbours that count this little are left out.
bool negligible(double weight) {
    return weight <= 1e-6 && weight >= -1e-6;
}

struct Lookup {
    const float* values = nullptr;
    std::array<Neighbours, kMaxAxes> at{};
    std::array<std::size_t, kMaxAxes> stride{};
    std::size_t axes = 0;
};

/// Value of the sub-table that begins at `offset`; `weight` is the product of the outer weights.
double value_at(const Lookup& lookup, std::size_t axis, std::size_t offset, double weight) {
    const Neighbours& n = lookup.at[axis];
    const std::size_t stride = lookup.stride[axis];
    const std::size_t i = offset + n.first * stride;
    if (axis + 1 == lookup.axes) {
        return n.weight0 * static_cast<double>(lookup.values[i]) +
               n.weight1 * static_cast<double>(lookup.values[i + 1]);
    }
    const double outer0 = weight * n.weight0, outer1 = weight * n.weight1;
    double sum = 0;
    if (!negligible(outer0)) sum += n.weight0 * value_at(lookup, axis + 1, i, outer0);
    if (!negligible(outer1)) sum += n.weight1 * value_at(lookup, axis + 1, i + stride, outer1);
    return sum;
}

}  // namespace

double interpolate(const DataArray& table, std::span<const double> point) {
    assert(!table.axes.empty() && table.axes.size() <= kMaxAxes &&
           point.size() >= table.axes.size());
    Lookup lookup;
    lookup.values = table.values.data();
    lookup.axes = table.axes.size();
    std::size_t stride = 1;
    for (std::size_t axis = lookup.axes; axis-- > 0;) {
        lookup.at[axis] = neighbours(table.axes[axis], point[axis]);
        lookup.stride[axis] = stride;
        stride *= table.axes[axis].count;
    }
    return value_at(lookup, 0, 0, 1);
}

Rgb interpolate(const PictureData& picture, double u, double v) {
    const Neighbours row = neighbours(picture.axes[0], v), column = neighbours(picture.axes[1], u);
    const std::size_t width = picture.axes[1].count;
    std::array<double, 3> sum{};
    const auto add_row = [&](std::size_t y, double weight) {
        if (negligible(weight)) return;
        const Rgb* pixel = &picture.values[y * width + column.first];
        const Rgb& right = width > 1 ? pixel[1] : pixel[0];
        for (std::size_t k = 0; k < 3; ++k) {
            sum[k] += weight * (column.weight0 * static_cast<double>((*pixel)[k]) +
                                column.weight1 * static_cast<double>(right[k]));
        }
    };
    add_row(row.first, row.weight0);
    if (picture.axes[0].count > 1) add_row(row.first + 1, row.weight1);
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

double interpolate(const SpectralPicture& picture, double u, double v, std::size_t band) {
    const Neighbours row = neighbours(picture.axes[0], v), column = neighbours(picture.axes[1], u);
    const std::size_t width = picture.axes[1].count;
    const auto in_row = [&](std::size_t y, double weight) {
        if (negligible(weight)) return 0.0;
        const float* pixel = &picture.values[(y * width + column.first) * picture.bands + band];
        const float right = width > 1 ? pixel[picture.bands] : *pixel;
        return weight * (column.weight0 * static_cast<double>(*pixel) +
                         column.weight1 * static_cast<double>(right));
    };
    const double sum = in_row(row.first, row.weight0);
    return picture.axes[0].count > 1 ? sum + in_row(row.first + 1, row.weight1) : sum;
}

}  // namespace lightwalk
