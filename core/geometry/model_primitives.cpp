#include "core/geometry/model_primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

Vec3 to_vec3(const MeshModel::Vertex& vertex) {
    return {vertex.x, vertex.y, vertex.z};
}

/// Neither NaN nor so large that products overflow.
bool is_usable(const MeshModel::Vertex& v) {
    return std::abs(v.x) <= kLargestCoordinate && std::abs(v.y) <= kLargestCoordinate &&
           std::abs(v.z) <= kLargestCoordinate;
}

[[noreturn]] void fail(const MeshPart& part, std::span<const Surface> surfaces,
                       std::size_t triangle, const char* problem) {
    const auto i = static_cast<std::size_t>(index(part.surface));
    const SourceLocation where = i < surfaces.size() ? surfaces[i].where : SourceLocation{};
    throw InputError(where, "mesh triangle " + std::to_string(triangle) + ": " + problem);
}

void validate(const MeshPart& part, std::span<const Surface> surfaces) {
    const MeshModel& mesh = *part.mesh;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const MeshModel::Triangle& t = mesh.triangles[i];
        for (const std::uint32_t v : t.v) {
            if (v >= mesh.positions.size()) fail(part, surfaces, i, "no such vertex");
            if (!is_usable(mesh.positions[v])) fail(part, surfaces, i, "vertex out of range");
            if (t.has_normals && v >= mesh.normals.size())
                fail(part, surfaces, i, "no such vertex normal");
            if (t.has_uvs && (v >= mesh.us.size() || v >= mesh.vs.size())) {
                fail(part, surfaces, i, "no such texture coordinate");
            }
        }
        const auto known =
            static_cast<std::int64_t>(std::min(part.materials.size(), part.traits.size()));
        if (t.material >= known) fail(part, surfaces, i, "no such material");
    }
}

/// Twice the area, signed, of the edge a -> b as the ray sees it from the origin. Antisymmetric to
/// the last bit, so that two triangles with a common edge leave no gap and share no more than the
/// edge itself. Source: Platis & Theoharis, "Fast Ray-Tetrahedron Intersection Using Plucker
/// Coordinates", 2003.
double edge_side(const Vec3& direction, const Vec3& a, const Vec3& b) {
    return dot(direction, cross(a, b));
}

}  // namespace

Precedence precedence_of(const SurfaceTraits& traits, bool front, ModifierId modifier,
                         SurfaceId surface) {
    return {traits.has_material, !traits.transparent, front, index(modifier), index(surface)};
}

ModelPrimitives::ModelPrimitives(std::span<const Surface> surfaces, const ModelGeometry& model)
    : surfaces_(surfaces), meshes_(model.meshes) {
    reserve(model);
    for (const SurfaceId id : model.surfaces) {
        const Shape& shape = surfaces[static_cast<std::size_t>(index(id))].shape;
        if (std::holds_alternative<std::monostate>(shape) ||
            std::holds_alternative<SourceShape>(shape))
            continue;
        const auto* polygon = std::get_if<PolygonShape>(&shape);
        if (polygon && polygon->vertices.size() > kLargePolygon) {
            large_polygons_.emplace(index(id), EdgeIndex(*polygon));
        }
        const bool packed = polygon && polygon->vertices.size() <= kLargePolygon;
        own_.push_back({id, packed ? packed_.add(*polygon) : kNotPacked,
                        surfaces[static_cast<std::size_t>(index(id))].traits.shadow});
    }
    size_ = own_.size();
    for (const MeshPart& part : meshes_) {
        validate(part, surfaces);
        size_ += part.mesh->triangles.size();
    }
    if (size_ > std::numeric_limits<std::int32_t>::max())
        throw InputError("too many surfaces in one model");
}

void ModelPrimitives::reserve(const ModelGeometry& model) {
    std::size_t polygons = 0, vertices = 0;
    for (const SurfaceId id : model.surfaces) {
        const auto* polygon =
            std::get_if<PolygonShape>(&surfaces_[static_cast<std::size_t>(index(id))].shape);
        if (!polygon || polygon->vertices.size() > kLargePolygon) continue;
        ++polygons;
        vertices += polygon->vertices.size();
    }
    own_.reserve(model.surfaces.size());
    packed_.reserve(polygons, vertices);
}

Vec3 ModelPrimitives::TriangleRef::corner(int i) const {
    return to_vec3(part->mesh->positions[triangle->v[i]]);
}

ModelPrimitives::TriangleRef ModelPrimitives::triangle(std::uint32_t primitive) const {
    std::size_t i = primitive - own_.size();
    const MeshPart* part = meshes_.data();
    for (; i >= part->mesh->triangles.size(); ++part) i -= part->mesh->triangles.size();
    return {part, &part->mesh->triangles[i]};
}

std::optional<ShapeHit> ModelPrimitives::intersect_surface(SurfaceId surface, const Vec3& origin,
                                                           const Vec3& direction,
                                                           double t_max) const {
    const Shape& shape = surfaces_[static_cast<std::size_t>(index(surface))].shape;
    if (const auto* cone = std::get_if<ConeShape>(&shape))  // trees are made of these
        return lightwalk::intersect(*cone, origin, direction, t_max);
    const auto* polygon = std::get_if<PolygonShape>(&shape);
    if (!polygon) return lightwalk::intersect(shape, origin, direction, t_max);
    const EdgeIndex* edges = nullptr;
    if (polygon->vertices.size() > kLargePolygon) {
        const auto large = large_polygons_.find(index(surface));
        if (large != large_polygons_.end()) edges = &large->second;
    }
    return lightwalk::intersect(*polygon, origin, direction, t_max, edges);
}

std::optional<ShapeHit> ModelPrimitives::intersect_triangle(std::uint32_t primitive,
                                                            const Vec3& origin,
                                                            const Vec3& direction,
                                                            double t_max) const {
    const TriangleRef ref = triangle(primitive);
    const Vec3 a = ref.corner(0) - origin, b = ref.corner(1) - origin, c = ref.corner(2) - origin;
    const Vec3 normal = cross(b - a, c - a);
    const double facing = dot(normal, direction);
    const double t = dot(normal, a) / facing;
    if (!(t > kEpsilon && t <= t_max)) return std::nullopt;  // also NaN: no area, or seen edge-on
    const double ab = edge_side(direction, a, b), bc = edge_side(direction, b, c),
                 ca = edge_side(direction, c, a);
    const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    if (!inside) return std::nullopt;
    const Vec3 unit = normalize(normal);
    if (unit == Vec3{}) return std::nullopt;
    return ShapeHit{t, unit, facing < 0};
}

Bounds ModelPrimitives::hit_bounds(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return lightwalk::hit_bounds(own_surface(primitive).shape);
    const TriangleRef ref = triangle(primitive);
    Bounds bounds;
    for (int i = 0; i < 3; ++i) bounds.extend(ref.corner(i));
    return bounds;
}

Bounds ModelPrimitives::bounds() const {
    Bounds bounds;
    for (const Own& own : own_) {
        extend(bounds, bounds_of(surfaces_[static_cast<std::size_t>(index(own.surface))].shape));
    }
    for (const MeshPart& part : meshes_) {
        for (const MeshModel::Vertex& vertex : part.mesh->positions)
            if (is_usable(vertex)) bounds.extend(to_vec3(vertex));
    }
    return bounds;
}

const SurfaceTraits& ModelPrimitives::traits(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return own_surface(primitive).traits;
    const TriangleRef ref = triangle(primitive);
    const std::int32_t material = ref.triangle->material;
    return material < 0 ? ref.part->void_traits
                        : ref.part->traits[static_cast<std::size_t>(material)];
}

ModifierId ModelPrimitives::modifier(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return own_surface(primitive).modifier;
    const TriangleRef ref = triangle(primitive);
    const std::int32_t material = ref.triangle->material;
    return material < 0 ? kVoid : ref.part->materials[static_cast<std::size_t>(material)];
}

ModelPrimitives::Smoothing ModelPrimitives::smoothing(std::uint32_t primitive, const Vec3& position,
                                                      const Vec3& normal) const {
    const TriangleRef ref = triangle(primitive);
    const MeshModel& mesh = *ref.part->mesh;
    const Vec3 a = ref.corner(0) - position, b = ref.corner(1) - position,
               c = ref.corner(2) - position;
    double weights[3] = {dot(normal, cross(b, c)), dot(normal, cross(c, a)),
                         dot(normal, cross(a, b))};
    const double sum = weights[0] + weights[1] + weights[2];
    Smoothing result;
    if (!(sum > 0)) return result;
    Vec3 smooth;
    for (int i = 0; i < 3; ++i) {
        const double w = weights[i] / sum;
        const std::uint32_t v = ref.triangle->v[i];
        if (ref.triangle->has_normals) smooth += to_vec3(mesh.normals[v]) * w;
        if (!ref.triangle->has_uvs) continue;
        result.u += mesh.us[v] * w;
        result.v += mesh.vs[v] * w;
    }
    smooth = normalize(smooth);
    if (smooth != Vec3{}) result.perturbation = smooth - normal;
    return result;
}

std::size_t ModelPrimitives::memory_bytes() const {
    std::size_t bytes = own_.capacity() * sizeof(Own) + packed_.memory_bytes();
    for (const auto& [surface, edges] : large_polygons_)
        bytes += sizeof(surface) + edges.memory_bytes();
    return bytes;
}

}  // namespace lightwalk
