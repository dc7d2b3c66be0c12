#include "core/geometry/search_space.h"

#include <algorithm>
#include <cstddef>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

/// How far single precision may be off, relative to the numbers involved: origin, direction and box
/// test of a ray (Embree's fast one: four half units), 16 half units in the last place altogether;
/// twice that through an instance's matrix.
constexpr double kRounding = 0x1p-20;
constexpr double kInstanceRounding = 2 * kRounding;
constexpr double kRegion = 4;    ///< rays start within this many times the scene's reach
constexpr double kMostOf = 0.9;  ///< part of the scene that the reach holds

double quantile(std::vector<double> values, double part) {
    if (values.empty()) return 0;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) * part);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

Vec3 center_of(const Bounds& bounds) {
    return (bounds.lower + bounds.upper) * 0.5;
}

Bounds moved(Bounds bounds, const Vec3& by) {
    bounds.lower += by;
    bounds.upper += by;
    return bounds;
}

/// Where most of the boxes are: an enormous ground plane or one stray surface does not matter.
Vec3 middle_of(const std::vector<Bounds>& boxes) {
    Vec3 middle;
    std::vector<double> values(boxes.size());
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < boxes.size(); ++i) values[i] = center_of(boxes[i])[k];
        middle[k] = quantile(values, 0.5);
    }
    return middle;
}

std::vector<Bounds> own_boxes(const ModelPrimitives& model) {
    std::vector<Bounds> boxes(model.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) boxes[i] = model.hit_bounds(i);
    return boxes;
}

/// Boxes in the world: first the scene's own primitives, then one for each placed model.
std::vector<Bounds> world_boxes(const PlacedScene& scene, const std::vector<Bounds>& model_boxes) {
    std::vector<Bounds> boxes = own_boxes(scene.primitives(0));
    boxes.reserve(boxes.size() + scene.frames().size());
    for (const PlacedModel& frame : scene.frames()) {
        const Matrix& matrix = frame.to_world.forward;
        const Bounds& inside = model_boxes[frame.model];
        boxes.push_back(inside.empty() ? Bounds{matrix.row[3], matrix.row[3]}
                                       : transformed(inside, matrix));
    }
    return boxes;
}

}  // namespace

Bounds SearchSpace::box(Bounds bounds) const {
    bounds = moved(bounds, -center);
    return grown(bounds, margin + relative * magnitude(bounds));
}

std::vector<SearchSpace> search_spaces(const PlacedScene& scene) {
    std::vector<SearchSpace> spaces(scene.model_count());
    std::vector<Bounds> model_boxes(scene.model_count());
    for (std::uint32_t m = 0; m < scene.model_count(); ++m) {
        model_boxes[m] = scene.primitives(m).bounds();
        if (m > 0) spaces[m].center = middle_of(own_boxes(scene.primitives(m)));
    }
    const std::vector<Bounds> boxes = world_boxes(scene, model_boxes);
    spaces[0].center = middle_of(boxes);
    std::vector<double> reach;
    reach.reserve(boxes.size());
    for (const Bounds& box : boxes) reach.push_back(magnitude(moved(box, -spaces[0].center)));
    const double region = kRegion * quantile(reach, kMostOf);
    spaces[0].margin = kRounding * region;
    spaces[0].relative = kRounding;

    const std::size_t own = scene.primitives(0).size();
    for (std::size_t i = 0; i < scene.frames().size(); ++i) {
        const PlacedModel& frame = scene.frames()[i];
        SearchSpace& space = spaces[frame.model];
        const double margin = kInstanceRounding * (region + reach[own + i]) / frame.to_world.size();
        space.margin = std::max(space.margin, margin);
        space.relative = kInstanceRounding;
    }
    for (std::size_t m = 1; m < spaces.size();
         ++m) {  // copies that shrink to nothing must not spoil the others
        if (model_boxes[m].empty()) continue;
        const Vec3 size = model_boxes[m].upper - model_boxes[m].lower;
        spaces[m].margin = std::min(spaces[m].margin, 0.01 * std::max({size.x, size.y, size.z}));
    }
    return spaces;
}

}  // namespace lightwalk
