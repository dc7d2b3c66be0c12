#include "core/geometry/instances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace lightwalk {
namespace {

SourceLocation location(const GeometryInput& input, SurfaceId surface) {
    const auto i = static_cast<std::size_t>(index(surface));
    return surface == kNoSurface || i >= input.surfaces->size()
               ? SourceLocation{}
               : (*input.surfaces)[surface].where();
}

/// Whether a model has surfaces of its own that a ray can hit, beside the models placed in it.
bool holds_anything(const SurfacePart& part) {
    for (std::size_t i = 0; i < part.shapes->size(); ++i)
        if (part.shapes->is_finite(i)) return true;
    return false;
}

/// Largest magnitude of an element; infinite where one is NaN.
double largest(const Matrix& matrix) {
    double most = 0;
    for (const Vec3& row : matrix.row) {
        for (const double x : {row.x, row.y, row.z}) {
            if (!std::isfinite(x)) return std::numeric_limits<double>::infinity();
            most = std::max(most, std::abs(x));
        }
    }
    return most;
}

/// Bounds of the matrix elements over all paths to a model.
struct ElementBounds {
    double forward = 1, inverse = 1;
};

/// Bound of an element of the product of two matrices, given bounds of their elements.
double product_bound(double a, double b) {
    return 3 * a * b + b;
}

}  // namespace

InnerSpace space_in(const InnerSpace* around, const Placement& placement) {
    const Transform& transform = placement.transform;
    const SurfaceId own = placement.overrides ? placement.surface : kNoSurface;
    if (!around) return {transform.inverse, transform.size(), placement.model, own};
    return {around->to_local * transform.inverse, transform.size() * around->size, placement.model,
            around->override_surface != kNoSurface ? around->override_surface : own};
}

InstancePaths::InstancePaths(const GeometryInput& input)
    : children_(input.models.size()),
      counts_(input.models.size(), 0),
      heights_(input.models.size(), -1),
      uses_(input.models.size()) {
    for (const ModelGeometry& model : input.models) {
        for (const Placement& placement : model.placements) {
            if (placement.model >= input.models.size())
                throw InputError(location(input, placement.surface),
                                 "placement of an unknown model");
        }
    }
    if (input.models.empty()) return;
    visit(input, 0, 0);
    std::reverse(order_.begin(), order_.end());
    if (count() > kMaxInstances) {
        throw InputError("instances inside instances multiply to more than " +
                         std::to_string(kMaxInstances) + " copies, the most that are supported");
    }
    find_uses(input);
}

/// Depth-first search: appends a model to order_ after all models placed in it.
void InstancePaths::visit(const GeometryInput& input, std::uint32_t model, int depth) {
    int height = 0;
    std::size_t instances = 0;
    for (const Placement& placement : input.models[model].placements) {
        if (depth >= kMaxNesting)
            throw InputError(location(input, placement.surface), "nested too deeply");
        const std::uint32_t inside = placement.model;
        if (heights_[inside] < 0) visit(input, inside, depth + 1);
        if (depth + 1 + heights_[inside] > kMaxNesting)
            throw InputError(location(input, placement.surface), "nested too deeply");
        height = std::max(height, heights_[inside] + 1);
        const ModelGeometry& contents = input.models[inside];
        if (counts_[inside] == 0 && contents.meshes.empty() &&
            !holds_anything(input.surfaces->part(contents.part)))
            continue;
        children_[model].push_back({&placement, static_cast<std::int32_t>(instances) + 1});
        instances = std::min(instances + 1 + counts_[inside], kMaxInstances + 1);
    }
    heights_[model] = height;
    counts_[model] = instances;
    order_.push_back(model);
}

void InstancePaths::find_uses(const GeometryInput& input) {
    std::vector<ElementBounds> elements(children_.size());
    uses_[0].used = true;
    for (const std::uint32_t model : order_) {
        if (!uses_[model].used) continue;
        for (const PlacedChild& child : children_[model]) {
            const Transform& transform = child.placement->transform;
            const double least = uses_[model].least_size * transform.size(),
                         most = uses_[model].most_size * transform.size();
            const ElementBounds reach{
                product_bound(largest(transform.forward), elements[model].forward),
                product_bound(elements[model].inverse, largest(transform.inverse))};
            if (!std::isfinite(reach.forward) || !std::isfinite(reach.inverse) ||
                !(least >= kSmallestScale && most <= kLargestScale)) {
                throw InputError(location(input, child.placement->surface),
                                 "bad transform: expected a total scale between 1e-7 and 1e7");
            }
            ModelUse& use = uses_[child.placement->model];
            ElementBounds& element = elements[child.placement->model];
            use.least_size = use.used ? std::min(use.least_size, least) : least;
            use.most_size = use.used ? std::max(use.most_size, most) : most;
            use.used = true;
            element.forward = std::max(element.forward, reach.forward);
            element.inverse = std::max(element.inverse, reach.inverse);
        }
    }
    std::erase_if(order_, [&](std::uint32_t model) { return !uses_[model].used; });
}

/// The placement in `model` that contains the `left`-th instance inside it. Interpolation search:
/// exact at the first step where all placements contain equally many.
const PlacedChild& InstancePaths::child_with(std::uint32_t model, std::int32_t left) const {
    const std::vector<PlacedChild>& all = children_[model];
    const auto guess = static_cast<std::size_t>(left - 1) * all.size() / counts_[model];
    if (all[guess].first <= left && (guess + 1 == all.size() || left < all[guess + 1].first))
        return all[guess];
    return *std::prev(std::upper_bound(
        all.begin(), all.end(), left,
        [](std::int32_t value, const PlacedChild& child) { return value < child.first; }));
}

/// visit(placement, instance around it) for each placement on the way to `instance`.
template <class Visit>
void InstancePaths::follow(InstanceId instance, const Visit& visit) const {
    std::uint32_t model = 0;
    std::int32_t left = index(instance) - index(kWorld);
    for (InstanceId around = kWorld; left > 0;) {
        const PlacedChild& child = child_with(model, left);
        visit(*child.placement, around);
        model = child.placement->model;
        left -= child.first;
        around = InstanceId{index(around) + child.first};
    }
}

PlacedModel InstancePaths::at(InstanceId instance) const {
    PlacedModel placed;
    follow(instance, [&placed](const Placement& placement, InstanceId around) {
        if (placement.overrides && placed.override_surface == kNoSurface) {
            placed.override_surface = placement.surface;
            placed.override_instance = around;
        }
        placed.to_world =
            around == kWorld ? placement.transform : placement.transform * placed.to_world;
        placed.model = placement.model;
    });
    return placed;
}

InnerSpace InstancePaths::space_at(InstanceId instance) const {
    InnerSpace space;
    follow(instance, [&space](const Placement& placement, InstanceId around) {
        space = space_in(around == kWorld ? nullptr : &space, placement);
    });
    return space;
}

}  // namespace lightwalk
