#pragma once
// Surfaces as the intersector sees them.
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/geometry/surface_shapes.h"
#include "core/model/ids.h"
#include "core/model/surface_list.h"

namespace lightwalk {

/// How a surface affects shadow queries, derived from its modifier chain.
enum class ShadowClass : std::uint8_t {
    ignored,            ///< no material: the ray passes as if nothing were there
    blocks,             ///< opaque: one such surface before the light blocks it
    needs_shading,      ///< glass, trans, mixtures, ...: its transmission has to be calculated
    clear_from_behind,  ///< illum without an alternate: as nothing for rays that meet its back,
                        ///< else it needs shading
};

/// Tie rules of coincident surfaces and shadow queries, derived from the modifier chain.
struct SurfaceTraits {
    bool has_material = false;
    bool transparent = false;  ///< nominally transparent material (Radiance's isopaque rule)
    ShadowClass shadow = ShadowClass::ignored;
};

/// Traits by modifier.
class ModifierTraits {
  public:
    /// @param traits  of all modifiers, by their ids
    /// @param none    of surfaces whose modifier is void
    ModifierTraits(std::vector<SurfaceTraits> traits, const SurfaceTraits& none)
        : traits_(std::move(traits)) {
        traits_.insert(traits_.begin(), none);
    }
    ModifierTraits() : traits_(1) {}
    [[nodiscard]] const SurfaceTraits& operator[](ModifierId id) const {
        return traits_[static_cast<std::size_t>(index(id)) + 1];  // -1 becomes 0
    }

  private:
    std::vector<SurfaceTraits> traits_;  ///< those of void first
};

/// The surfaces of one model and their numbers in the scene. Refers to lists that must outlive it.
struct SurfacePart {
    const SurfaceList* list = nullptr;
    const SurfaceShapes* shapes = nullptr;
    std::int32_t first = 0;          ///< id of its first surface
    std::int32_t modifier_base = 0;  ///< id of its model's first modifier

    [[nodiscard]] SurfaceId id(std::size_t i) const {
        return SurfaceId{first + static_cast<std::int32_t>(i)};
    }
    [[nodiscard]] ModifierId modifier(std::size_t i) const {
        const std::int32_t local = shapes->row(i).modifier;
        return local < 0 ? kVoid : ModifierId{modifier_base + local};
    }
};

class SurfaceTable;

/// One surface primitive: a view of a SurfaceTable.
class Surface {
  public:
    Surface(const SurfacePart& part, std::size_t i, const ModifierTraits& traits)
        : part_(&part), i_(i), traits_(&traits) {}

    [[nodiscard]] PrimitiveType type() const { return part_->shapes->row(i_).type; }
    [[nodiscard]] ModifierId modifier() const { return part_->modifier(i_); }
    [[nodiscard]] const SurfaceTraits& traits() const { return (*traits_)[modifier()]; }
    /// The name of the surface in the scene file.
    [[nodiscard]] std::string_view name() const { return (*part_->list)[i_].name; }
    [[nodiscard]] SourceLocation where() const { return (*part_->list)[i_].where(); }
    /// The shape; monostate for instances, meshes and degenerate (ignored) surfaces.
    [[nodiscard]] Shape shape() const { return part_->shapes->shape(*part_->list, i_); }
    [[nodiscard]] bool has_shape() const { return part_->shapes->row(i_).kind != ShapeKind::none; }
    /// Polygon or ring: what the reference calls a flat object.
    [[nodiscard]] bool is_flat() const {
        return type() == PrimitiveType::polygon || type() == PrimitiveType::ring;
    }

  private:
    const SurfacePart* part_;
    std::size_t i_;
    const ModifierTraits* traits_;
};

/// All surfaces of a scene, those of each model side by side.
class SurfaceTable {
  public:
    /// Add the surfaces of a model behind those there are; returns the number of the part.
    std::size_t add(const SurfaceList& list, const SurfaceShapes& shapes,
                    std::int32_t modifier_base);
    void set_traits(ModifierTraits traits) { traits_ = std::move(traits); }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t part_count() const { return parts_.size(); }
    [[nodiscard]] const SurfacePart& part(std::size_t number) const { return parts_[number]; }
    [[nodiscard]] const ModifierTraits& traits() const { return traits_; }
    [[nodiscard]] Surface operator[](SurfaceId id) const {
        const SurfacePart& part = part_of(id);
        return {part, static_cast<std::size_t>(index(id) - part.first), traits_};
    }
    [[nodiscard]] const SurfacePart& part_of(SurfaceId id) const;

  private:
    std::vector<SurfacePart> parts_;
    std::size_t size_ = 0;
    ModifierTraits traits_;
};

}  // namespace lightwalk
