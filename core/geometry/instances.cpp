#include "core/geometry/instances.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lightwalk {
namespace {

constexpr int kMaxDepth = 1000;

SourceLocation location(const GeometryInput& input, SurfaceId surface) {
    const auto i = static_cast<std::size_t>(index(surface));
    return surface == kNoSurface || i >= input.surfaces.size() ? SourceLocation{}
                                                               : input.surfaces[i].where;
}

bool is_finite(const Matrix& matrix) {
    return std::all_of(matrix.row.begin(), matrix.row.end(), [](const Vec3& row) {
        return std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.z);
    });
}

/// Number of paths below each model, to be known before any of them is built.
class PathCounter {
  public:
    explicit PathCounter(const GeometryInput& input)
        : input_(input), paths_(input.models.size()), known_(input.models.size(), false) {}

    /// Frames that a model's placements need, itself not counted; at most kMaxInstances + 1.
    std::size_t below(std::uint32_t model, int depth) {
        if (known_[model]) return paths_[model];
        std::size_t sum = 0;
        for (const Placement& placement : input_.models[model].placements) {
            if (depth >= kMaxDepth)
                throw InputError(location(input_, placement.surface), "nested too deeply");
            sum = std::min(sum + with(placement.model, depth + 1), kMaxInstances + 1);
        }
        known_[model] = true;
        return paths_[model] = sum;
    }
    /// The same with the model itself; 0 when there is nothing to see in it.
    std::size_t with(std::uint32_t model, int depth) {
        const ModelGeometry& contents = input_.models[model];
        const std::size_t inside = below(model, depth);
        return inside == 0 && contents.surfaces.empty() && contents.meshes.empty() ? 0 : inside + 1;
    }

  private:
    const GeometryInput& input_;
    std::vector<std::size_t> paths_;
    std::vector<bool> known_;
};

class Flattener {
  public:
    explicit Flattener(const GeometryInput& input) : input_(input), counter_(input) {
        const std::size_t count = counter_.below(0, 0);
        if (count > kMaxInstances) {
            throw InputError("instances inside instances multiply to more than " +
                             std::to_string(kMaxInstances) +
                             " copies, the most that are supported");
        }
        frames.reserve(count);
        add_children(0, PlacedModel{}, kWorld);
    }
    std::vector<PlacedModel> frames;

  private:
    void add_children(std::uint32_t model, const PlacedModel& parent, FrameId parent_frame) {
        for (const Placement& placement : input_.models[model].placements) {
            if (counter_.with(placement.model, 0) == 0) continue;
            PlacedModel child = parent;
            child.model = placement.model;
            child.to_world = placement.transform * parent.to_world;
            if (!is_finite(child.to_world.forward) || !is_finite(child.to_world.inverse) ||
                !(child.to_world.size() >= kSmallestScale &&
                  child.to_world.size() <= kLargestScale)) {
                throw InputError(location(input_, placement.surface),
                                 "bad transform: expected a total scale between 1e-7 and 1e7");
            }
            if (placement.overrides && child.override_surface == kNoSurface) {
                child.override_surface = placement.surface;
                child.override_frame = parent_frame;
            }
            frames.push_back(child);
            const FrameId frame{static_cast<std::int32_t>(frames.size()) - 1};
            add_children(placement.model, child, frame);
        }
    }

    const GeometryInput& input_;
    PathCounter counter_;
};

}  // namespace

std::vector<PlacedModel> flatten_placements(const GeometryInput& input) {
    if (input.models.empty()) return {};
    for (const ModelGeometry& model : input.models) {
        for (const Placement& placement : model.placements) {
            if (placement.model >= input.models.size()) {
                throw InputError(location(input, placement.surface),
                                 "placement of an unknown model");
            }
        }
    }
    return std::move(Flattener(input).frames);
}

}  // namespace lightwalk
