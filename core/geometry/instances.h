#pragma once
// Nested placements: one instance for every path of placements that leads from the scene to a
// model. Instances are numbered, not stored: a model of a million leaves may stand a thousand
// times.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/geometry.h"

namespace lightwalk {

/// A model as one path of placements shows it.
struct PlacedModel {
    Transform to_world;
    std::uint32_t model = 0;
    /// The outermost placement of the path whose modifier shades everything inside, and the
    /// instance that this modifier lives in; nothing when the contents keep their own modifiers.
    SurfaceId override_surface = kNoSurface;
    InstanceId override_instance = kWorld;
};

/// What a search needs of a placed model.
struct InnerSpace {
    Matrix to_local;  ///< from the world
    double size = 1;  ///< of what is 1 long inside [m]
    std::uint32_t model = 0;
    SurfaceId override_surface = kNoSurface;  ///< see PlacedModel
};

/// The space of the model that `placement` places inside the placed model `around`; `around` null:
/// inside the scene itself.
[[nodiscard]] InnerSpace space_in(const InnerSpace* around, const Placement& placement);

/// A placement inside a model; the placed model is not empty.
struct PlacedChild {
    const Placement* placement = nullptr;
    /// Its instance number relative to the instance of the model that it is placed in.
    std::int32_t first = 0;
};

/// Whether, and at which sizes, a model occurs in the scene.
struct ModelUse {
    bool used = false;
    double least_size = 1, most_size = 1;  ///< total scales of its placements
};

/// Most paths of placements (instances) that a scene may have.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

/// Most placements in one path: each level takes a part of the stack while rays are cast.
inline constexpr int kMaxNesting = 32;

/// Limits of the total scale of a path of placements.
inline constexpr double kSmallestScale = 1e-7, kLargestScale = 1e7;

/// The paths of placements that lead to geometry, numbered depth first: an instance is followed by
/// the instances inside it. Immutable.
class InstancePaths {
  public:
    /// The input must outlive this. Throws InputError for more than kMaxInstances paths, for models
    /// nested deeper than kMaxNesting, and for transforms that are not finite or scale beyond the
    /// limits above.
    explicit InstancePaths(const GeometryInput& input);

    /// The number of instances.
    [[nodiscard]] std::size_t count() const { return counts_.empty() ? 0 : counts_[0]; }
    /// The number of instances inside one placement of a model, the placement itself not counted.
    [[nodiscard]] std::size_t count_inside(std::uint32_t model) const { return counts_[model]; }
    /// A model's placements, in the order of their instances.
    [[nodiscard]] std::span<const PlacedChild> children(std::uint32_t model) const {
        return children_[model];
    }
    [[nodiscard]] const ModelUse& use(std::uint32_t model) const { return uses_[model]; }
    /// All models that are used, in topological order: each before the models placed in it.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
    /// The placed model of an instance. @param instance  less than count(), or kWorld
    [[nodiscard]] PlacedModel at(InstanceId instance) const;
    /// The space of an instance: cheaper than at(). The instance must not be kWorld.
    [[nodiscard]] InnerSpace space_at(InstanceId instance) const;

  private:
    [[nodiscard]] const PlacedChild& child_with(std::uint32_t model, std::int32_t left) const;
    template <class Visit>
    void follow(InstanceId instance, const Visit& visit) const;
    void visit(const GeometryInput& input, std::uint32_t model, int depth);
    void find_uses(const GeometryInput& input);

    std::vector<std::vector<PlacedChild>> children_;  ///< by model
    std::vector<std::size_t> counts_;
    std::vector<int> heights_;  ///< longest path from each model; -1: not visited
    std::vector<ModelUse> uses_;
    std::vector<std::uint32_t> order_;
};

}  // namespace lightwalk
