#pragma once
// Which points of the cloud may show some materials: by what their hashes say of the surfaces on
// their way.
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/cloud/changed_places.h"
#include "core/cloud/point.h"
#include "core/scene/scene.h"

namespace lightwalk {

/// Says of points that they may show a material, as seen straight, through panes, or in mirrors:
/// always of those that do, and of others with the odds of a hash of eight bits (one in 256 for
/// each way on which some are seen). Of light that is scattered from there to other surfaces it
/// says nothing.
class ShownMaterials {
  public:
    /// @param wanted  by modifier, of surfaces of which at least one must be on the way
    ShownMaterials(const Scene& scene, const std::vector<bool>& wanted);

    /// Those that have these flags(). Throws InputError for another number of them.
    explicit ShownMaterials(std::span<const std::uint8_t> flags);
    /// All there is to know of them: for another process, whose points are of the same scene.
    [[nodiscard]] std::vector<std::uint8_t> flags() const;

    [[nodiscard]] bool may_show(const CloudPoint& point) const {
        return bits_[static_cast<std::size_t>(point.kind)][point.surface & kMaterialBits] ||
               (places_ && places_->may_touch(point));
    }
    /// From now on points that these may touch count as such that may show the materials.
    void add_places(ChangedPlaces places) { places_ = std::move(places); }

  private:
    using Bits = std::bitset<kMaterialBits + 1>;
    std::array<Bits, kPointKinds> bits_;
    std::optional<ChangedPlaces> places_;
};

/// Takes out the points that may show the materials; the others keep their order.
/// @param groups  what light groups add to each point, by point, then group; or empty
void drop_points(const ShownMaterials& materials, std::vector<CloudPoint>& points,
                 std::vector<Rgb>& groups);

}  // namespace lightwalk
