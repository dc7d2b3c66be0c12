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

/// Of what a placement shows in a placed model; in the scene itself, where `around` is null.
[[nodiscard]] InnerSpace space_in(const InnerSpace* around, const Placement& placement);

/// A placement in a model, of a model that holds something.
struct PlacedChild {
    const Placement* placement = nullptr;
    /// Its instance, less that of the placement of the model that it stands in.
    std::int32_t first = 0;
};

/// How often and how large a model stands in the scene.
struct ModelUse {
    bool used = false;
    double least_size = 1, most_size = 1;  ///< total scales of its placements
};

/// Paths that a scene may hold.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

/// Placements in one path: each takes a part of the stack while rays are cast.
inline constexpr int kMaxNesting = 32;

/// Total scale of a path of placements.
inline constexpr double kSmallestScale = 1e-7, kLargestScale = 1e7;

/// The paths that lead to geometry. A path's instance is followed by those of the paths that go on
/// from it. Immutable.
class InstancePaths {
  public:
    /// The input must outlive this. Throws InputError for more than kMaxInstances paths, for models
    /// nested deeper than kMaxNesting, and for transforms that are not finite or scale beyond the
    /// limits above.
    explicit InstancePaths(const GeometryInput& input);

    /// Instances in all.
    [[nodiscard]] std::size_t count() const { return counts_.empty() ? 0 : counts_[0]; }
    /// Instances inside a placement of a model, its own not counted.
    [[nodiscard]] std::size_t count_inside(std::uint32_t model) const { return counts_[model]; }
    /// A model's placements, in the order of their instances.
    [[nodiscard]] std::span<const PlacedChild> children(std::uint32_t model) const {
        return children_[model];
    }
    [[nodiscard]] const ModelUse& use(std::uint32_t model) const { return uses_[model]; }
    /// Of all models that are used: each before those that stand in it.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
    /// @param instance  less than count(), or kWorld
    [[nodiscard]] PlacedModel at(InstanceId instance) const;
    /// Of at(instance), for less; the instance is not kWorld.
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
