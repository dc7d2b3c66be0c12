#include "core/geometry/search_space.h"

#include <algorithm>
#include <cstddef>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

/// Rounding error of single precision, relative to the numbers involved. For rays in the world:
/// origin, direction and box test (Embree's fast one: four half units), 16 half units in the last
/// place altogether. For each matrix on the way into a model: five half units of the sum of three
/// coordinates at most, for origin and direction each.
constexpr double kRounding = 0x1p-20;
constexpr double kMatrixRounding = 1.1 * kRounding;
constexpr double kInstanceRounding = 2 * kRounding;  ///< of the boxes of placed models
constexpr double kRegion = 4;    ///< rays start within this many times the scene's reach
constexpr double kMostOf = 0.9;  ///< share of the scene within its reach

/// A box, and the number of boxes that it represents.
struct WeightedBox {
    Bounds bounds;
    double weight = 1;
};

struct WeightedValue {
    double value = 0, weight = 1;
};

/// The weighted quantile: the least value up to which lies `part` of the weight.
double quantile(std::vector<WeightedValue> values, double part) {
    std::sort(values.begin(), values.end(),
              [](const WeightedValue& a, const WeightedValue& b) { return a.value < b.value; });
    double all = 0, so_far = 0;
    for (const WeightedValue& value : values) all += value.weight;
    for (const WeightedValue& value : values) {
        so_far += value.weight;
        if (so_far >= part * all) return value.value;
    }
    return values.empty() ? 0 : values.back().value;
}

Vec3 center_of(const Bounds& bounds) {
    return (bounds.lower + bounds.upper) * 0.5;
}

Bounds moved(Bounds bounds, const Vec3& by) {
    bounds.lower += by;
    bounds.upper += by;
    return bounds;
}

/// The weighted median of the boxes: robust against an enormous ground plane or a stray surface.
Vec3 middle_of(const std::vector<WeightedBox>& boxes) {
    Vec3 middle;
    std::vector<WeightedValue> values(boxes.size());
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            values[i] = {center_of(boxes[i].bounds)[k], boxes[i].weight};
        middle[k] = quantile(values, 0.5);
    }
    return middle;
}

/// Boxes in a model.
struct BoxesIn {
    std::vector<WeightedBox> all;
    std::size_t own =
        0;  ///< the first so many boxes are of own primitives, the others of placed models
};

/// The boxes in a model; of many primitives an even sample, which suffices for medians. @param
/// inside  the boxes of the models placed in it
BoxesIn boxes_in(const PlacedScene& scene, std::uint32_t model, const std::vector<Bounds>& inside) {
    constexpr std::size_t kSample = std::size_t{1} << 16;
    const ModelPrimitives& own = scene.primitives(model);
    const std::size_t step = own.size() / kSample + 1;
    BoxesIn boxes;
    for (std::size_t i = 0; i < own.size(); i += step) {
        const Bounds bounds = own.hit_bounds(static_cast<std::uint32_t>(i));
        if (!bounds.empty()) boxes.all.push_back({bounds, static_cast<double>(step)});
    }
    boxes.own = boxes.all.size();
    for (const PlacedChild& child : scene.paths().children(model)) {
        const Matrix& matrix = child.placement->transform.forward;
        const std::uint32_t placed = child.placement->model;
        const Bounds bounds = inside[placed].empty() ? Bounds{matrix.row[3], matrix.row[3]}
                                                     : transformed(inside[placed], matrix);
        boxes.all.push_back({bounds, 1 + static_cast<double>(scene.paths().count_inside(placed))});
    }
    return boxes;
}

Bounds union_of(const ModelPrimitives& own, const BoxesIn& boxes) {
    Bounds all = own.all_hit_bounds();
    for (std::size_t i = boxes.own; i < boxes.all.size(); ++i) extend(all, boxes.all[i].bounds);
    return all;
}

}  // namespace

Bounds SearchSpace::box(Bounds bounds) const {
    bounds = moved(bounds, -center);
    return grown(bounds, margin + relative * magnitude(bounds));
}

std::vector<SearchSpace> search_spaces(const PlacedScene& scene) {
    const InstancePaths& paths = scene.paths();
    const std::size_t count = scene.model_count();
    std::vector<SearchSpace> spaces(count);
    std::vector<Bounds> inside(count);
    std::vector<std::vector<WeightedValue>> reaches(
        count);                                 // distances of all boxes from the centre
    std::vector<std::size_t> own_boxes(count);  // number of own boxes, which come first among them
    std::vector<double> region(count, 0);       // radius within which rays in a model start
    const std::span<const std::uint32_t> order = paths.order();
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const std::uint32_t model = *at;
        const BoxesIn boxes = boxes_in(scene, model, inside);
        inside[model] = union_of(scene.primitives(model), boxes);
        own_boxes[model] = boxes.own;
        spaces[model].center = middle_of(boxes.all);
        for (const WeightedBox& box : boxes.all)
            reaches[model].push_back(
                {magnitude(moved(box.bounds, -spaces[model].center)), box.weight});
    }
    region[0] = kRegion * quantile(reaches[0], kMostOf);
    spaces[0].margin = kRounding * region[0];
    spaces[0].relative = kRounding;
    for (const std::uint32_t model : order) {
        const Vec3 size = inside[model].upper - inside[model].lower;
        // Instances scaled down to nothing must not affect the others.
        if (model != 0 && !inside[model].empty())
            spaces[model].margin =
                std::min(spaces[model].margin, 0.01 * std::max({size.x, size.y, size.z}));
        std::size_t box = own_boxes[model];
        for (const PlacedChild& child : paths.children(model)) {
            const double scale = child.placement->transform.size();
            const double around = region[model] + reaches[model][box++].value;
            const std::uint32_t placed = child.placement->model;
            region[placed] = std::max(region[placed], around / scale);
            spaces[placed].margin = std::max(
                spaces[placed].margin, (spaces[model].margin + kMatrixRounding * around) / scale);
            spaces[placed].relative = kInstanceRounding;
        }
    }
    return spaces;
}

}  // namespace lightwalk
