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

/// What decides between coincident surfaces; the greater one is seen. A material beats none, then
/// an opaque material a transparent one, the front side the back, the later modifier, the later
/// surface.
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

/// Primitives of a model, numbered from 0. Keeps references to the surfaces and to the model's
/// meshes.
class ModelPrimitives {
  public:
    /// Throws InputError for mesh triangles whose vertices or materials do not exist.
    ModelPrimitives(std::span<const Surface> surfaces, const ModelGeometry& model);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool is_triangle(std::uint32_t primitive) const {
        return primitive >= own_.size();
    }

    /// Nearest crossing with t in (kEpsilon, t_max]; the direction is unit.
    [[nodiscard]] std::optional<ShapeHit> intersect(std::uint32_t primitive, const Vec3& origin,
                                                    const Vec3& direction, double t_max) const {
        if (is_triangle(primitive)) return intersect_triangle(primitive, origin, direction, t_max);
        const Own& own = own_[primitive];
        return own.packed != kNotPacked ? packed_.intersect(own.packed, origin, direction, t_max)
                                        : intersect_surface(own.surface, origin, direction, t_max);
    }
    /// The same for a surface of this model.
    [[nodiscard]] std::optional<ShapeHit> intersect_surface(SurfaceId surface, const Vec3& origin,
                                                            const Vec3& direction,
                                                            double t_max) const;
    /// Box of every point that `intersect` can report, before rounding.
    [[nodiscard]] Bounds hit_bounds(std::uint32_t primitive) const;
    /// The primitive's shape where it is a polygon, else null.
    [[nodiscard]] const PolygonShape* polygon(std::uint32_t primitive) const {
        return is_triangle(primitive) ? nullptr
                                      : std::get_if<PolygonShape>(&own_surface(primitive).shape);
    }
    /// Box around all surfaces and triangles themselves.
    [[nodiscard]] Bounds bounds() const;

    [[nodiscard]] const SurfaceTraits& traits(std::uint32_t primitive) const;
    [[nodiscard]] ShadowClass shadow(std::uint32_t primitive) const {
        return is_triangle(primitive) ? traits(primitive).shadow : own_[primitive].shadow;
    }
    [[nodiscard]] SurfaceId surface(std::uint32_t primitive) const {
        return is_triangle(primitive) ? triangle(primitive).part->surface : own_[primitive].surface;
    }
    [[nodiscard]] ModifierId modifier(std::uint32_t primitive) const;

    /// Smoothed normal minus normal [1] and texture coordinates at a triangle's hit.
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
    [[nodiscard]] const Surface& own_surface(std::uint32_t primitive) const {
        return surfaces_[static_cast<std::size_t>(index(own_[primitive].surface))];
    }
    void reserve(const ModelGeometry& model);
    [[nodiscard]] TriangleRef triangle(std::uint32_t primitive) const;
    [[nodiscard]] std::optional<ShapeHit> intersect_triangle(std::uint32_t primitive,
                                                             const Vec3& origin,
                                                             const Vec3& direction,
                                                             double t_max) const;

    std::span<const Surface> surfaces_;
    static constexpr std::uint32_t kNotPacked = ~std::uint32_t{0};
    /// What the search asks of every candidate, apart from the rest of its surface.
    struct Own {
        SurfaceId surface;
        std::uint32_t packed;  ///< handle of a packed polygon
        ShadowClass shadow;
    };
    std::vector<Own> own_;   ///< surfaces of this model that have a shape
    PackedPolygons packed_;  ///< all polygons but the large ones
    std::span<const MeshPart> meshes_;
    std::unordered_map<std::int32_t, EdgeIndex> large_polygons_;  ///< by index of the surface
    std::size_t size_ = 0;
};

}  // namespace lightwalk
