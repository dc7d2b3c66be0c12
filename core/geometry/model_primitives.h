#pragma once
// What a ray can hit inside one model, in the model's own space: its surfaces, then its meshes'
// triangles.
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/geometry/polygon.h"

namespace lightwalk {

/// Order of coincident surfaces, of which the greatest is seen. Compared in this order: with a
/// material over without one, opaque over transparent, front over back side, the later modifier,
/// the later surface.
struct Precedence {
    bool has_material = false, opaque = false, front = false;
    std::int32_t modifier = -1, surface = -1;
    friend bool operator>(const Precedence& a, const Precedence& b) {
        return std::tie(a.has_material, a.opaque, a.front, a.modifier, a.surface) >
               std::tie(b.has_material, b.opaque, b.front, b.modifier, b.surface);
    }
};

/// The precedence of a surface that a ray meets on its front or back.
[[nodiscard]] Precedence precedence_of(const SurfaceTraits& traits, bool front, ModifierId modifier,
                                       SurfaceId surface);

/// Primitives of a model, numbered from 0: its surfaces, in their order, then its meshes'
/// triangles. Keeps references to the surfaces and to the model's meshes.
class ModelPrimitives {
  public:
    /// Throws InputError for mesh triangles whose vertices or materials do not exist.
    ModelPrimitives(const SurfaceTable& surfaces, const ModelGeometry& model,
                    const TaskRunner& task_runner);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool is_triangle(std::uint32_t primitive) const { return primitive >= own_; }
    /// Whether a ray can hit the primitive. Surfaces without a shape and sources at infinity have
    /// numbers, too, but cannot be hit.
    [[nodiscard]] bool is_finite(std::uint32_t primitive) const {
        return is_triangle(primitive) || part_->shapes->is_finite(primitive);
    }

    /// Nearest crossing with t in (kEpsilon, t_max]; the direction is unit.
    [[nodiscard]] std::optional<ShapeHit> intersect(std::uint32_t primitive, const Vec3& origin,
                                                    const Vec3& direction, double t_max) const {
        if (is_triangle(primitive)) return intersect_triangle(primitive, origin, direction, t_max);
        const ShapeRow& row = rows_[primitive];
        if (row.kind == ShapeKind::polygon) {
            if (row.plane.corners <= kLargePolygon)
                return lightwalk::intersect(row.plane, row.manner, numbers_, origin, direction,
                                            t_max);
        }
        return intersect_other(primitive, origin, direction, t_max);
    }
    /// Box of every point that `intersect` can report, before rounding.
    [[nodiscard]] Bounds hit_bounds(std::uint32_t primitive) const;
    /// The primitive's shape where it is a polygon.
    [[nodiscard]] std::optional<PolygonShape> polygon(std::uint32_t primitive) const;
    /// The primitive's shape where it is a cone, cup, cylinder or tube; else null.
    [[nodiscard]] const ConeShape* cone(std::uint32_t primitive) const {
        if (is_triangle(primitive) || rows_[primitive].kind != ShapeKind::cone) return nullptr;
        return &part_->shapes->cone(rows_[primitive].index());
    }
    /// Bound of the half_area of the hit_bounds of a primitive that is a polygon, known without
    /// looking at the polygon [m²].
    [[nodiscard]] double half_area_at_most(std::uint32_t primitive) const {
        return most_half_area_[primitive / kGrain];
    }
    /// Box around all surfaces and triangles themselves.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Box around what hit_bounds gives for all of them.
    [[nodiscard]] const Bounds& all_hit_bounds() const { return all_hit_bounds_; }

    [[nodiscard]] const SurfaceTraits& traits(std::uint32_t primitive) const;
    [[nodiscard]] ShadowClass shadow(std::uint32_t primitive) const {
        return traits(primitive).shadow;
    }
    [[nodiscard]] SurfaceId surface(std::uint32_t primitive) const {
        return is_triangle(primitive) ? triangle(primitive).part->surface : part_->id(primitive);
    }
    /// The primitive of a surface of this model.
    [[nodiscard]] std::uint32_t primitive_of(SurfaceId surface) const {
        return static_cast<std::uint32_t>(index(surface) - part_->first);
    }
    [[nodiscard]] ModifierId modifier(std::uint32_t primitive) const;

    /// The smoothed normal minus the normal, and texture coordinates, at a hit of a mesh triangle.
    struct Smoothing {
        Vec3 perturbation;
        double u = 0, v = 0;
    };
    [[nodiscard]] Smoothing smoothing(std::uint32_t primitive, const Vec3& position,
                                      const Vec3& normal) const;
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    struct TriangleRef {
        const MeshPart* part;
        const MeshModel::Triangle* triangle;
        [[nodiscard]] Vec3 corner(int i) const;
    };
    void find_bounds(const TaskRunner& task_runner);
    [[nodiscard]] TriangleRef triangle(std::uint32_t primitive) const;
    [[nodiscard]] std::optional<ShapeHit> intersect_triangle(std::uint32_t primitive,
                                                             const Vec3& origin,
                                                             const Vec3& direction,
                                                             double t_max) const;

    [[nodiscard]] std::optional<ShapeHit> intersect_other(std::uint32_t primitive,
                                                          const Vec3& origin, const Vec3& direction,
                                                          double t_max) const;

    const SurfacePart* part_;
    const ModifierTraits* traits_;
    // Pointers into the part's columns, for what the search needs of every candidate.
    const ShapeRow* rows_;
    CornerNumbers numbers_;
    std::size_t own_;  ///< surfaces of this model, those without a shape among them
    std::span<const MeshPart> meshes_;
    std::unordered_map<std::uint32_t, EdgeIndex> large_polygons_;  ///< by primitive
    std::size_t size_ = 0;
    Bounds bounds_, all_hit_bounds_;
    std::vector<double> most_half_area_;  ///< of the polygons among each kGrain primitives
};

}  // namespace lightwalk
