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

[[noreturn]] void fail(const MeshPart& part, const SurfaceTable& surfaces, std::size_t triangle,
                       const char* problem) {
    const auto i = static_cast<std::size_t>(index(part.surface));
    const SourceLocation where =
        i < surfaces.size() ? surfaces[part.surface].where() : SourceLocation{};
    throw InputError(where, "mesh triangle " + std::to_string(triangle) + ": " + problem);
}

void validate(const MeshPart& part, const SurfaceTable& surfaces) {
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

ModelPrimitives::ModelPrimitives(const SurfaceTable& surfaces, const ModelGeometry& model,
                                 const TaskRunner& task_runner)
    : part_(&surfaces.part(model.part)),
      traits_(&surfaces.traits()),
      rows_(part_->shapes->columns().rows.data()),
      numbers_{part_->list->columns().reals.data(), part_->list->columns().corners.data()},
      own_(part_->shapes->size()),
      meshes_(model.meshes),
      size_(own_) {
    for (std::uint32_t i = 0; i < own_; ++i) {
        if (rows_[i].kind == ShapeKind::polygon && rows_[i].plane.corners > kLargePolygon)
            large_polygons_.emplace(i, EdgeIndex(part_->shapes->polygon(*part_->list, i)));
    }
    for (const MeshPart& part : meshes_) {
        validate(part, surfaces);
        size_ += part.mesh->triangles.size();
    }
    if (size_ > std::numeric_limits<std::int32_t>::max())
        throw InputError("too many surfaces in one model");
    find_bounds(task_runner);
}

void ModelPrimitives::find_bounds(const TaskRunner& task_runner) {
    std::vector<Bounds> own(part_count(size_)), hits(own.size());
    most_half_area_.resize(own.size());
    for_each_part(task_runner, size_, [&](std::size_t part, std::size_t first, std::size_t last) {
        // Local, not in the shared arrays, to avoid false sharing.
        Bounds all_hits, all_own;
        double most = 0;
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
            const std::optional<PolygonShape> shape = polygon(i);
            const Bounds hit = shape ? lightwalk::hit_bounds(*shape) : hit_bounds(i);
            extend(all_hits, hit);
            if (is_triangle(i)) continue;
            if (shape) most = std::max(most, half_area(hit));
            extend(all_own,
                   shape ? bounds_of(*shape) : bounds_of(part_->shapes->shape(*part_->list, i)));
        }
        hits[part] = all_hits;
        own[part] = all_own;
        most_half_area_[part] = most;
    });
    for (const Bounds& part : own) extend(bounds_, part);
    for (const Bounds& part : hits) extend(all_hit_bounds_, part);
    for (const MeshPart& part : meshes_) {
        for (const MeshModel::Vertex& vertex : part.mesh->positions)
            if (is_usable(vertex)) bounds_.extend(to_vec3(vertex));
    }
}

Vec3 ModelPrimitives::TriangleRef::corner(int i) const {
    return to_vec3(part->mesh->positions[triangle->v[i]]);
}

ModelPrimitives::TriangleRef ModelPrimitives::triangle(std::uint32_t primitive) const {
    std::size_t i = primitive - own_;
    const MeshPart* part = meshes_.data();
    for (; i >= part->mesh->triangles.size(); ++part) i -= part->mesh->triangles.size();
    return {part, &part->mesh->triangles[i]};
}

std::optional<ShapeHit> ModelPrimitives::intersect_other(std::uint32_t primitive,
                                                         const Vec3& origin, const Vec3& direction,
                                                         double t_max) const {
    const ShapeRow& row = rows_[primitive];
    if (row.kind == ShapeKind::cone)  // a frequent case: vegetation is made of cones
        return lightwalk::intersect(part_->shapes->cone(row.index()), origin, direction, t_max);
    if (row.kind != ShapeKind::polygon)
        return lightwalk::intersect(part_->shapes->shape(*part_->list, primitive), origin,
                                    direction, t_max);
    return lightwalk::intersect(part_->shapes->polygon(*part_->list, primitive), origin, direction,
                                t_max, &large_polygons_.at(primitive));
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
    if (!(t > kEpsilon && t <= t_max))
        return std::nullopt;  // NaN as well: no area, or seen edge-on
    const double ab = edge_side(direction, a, b), bc = edge_side(direction, b, c),
                 ca = edge_side(direction, c, a);
    const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    if (!inside) return std::nullopt;
    const Vec3 unit = normalize(normal);
    if (unit == Vec3{}) return std::nullopt;
    return ShapeHit{t, unit, facing < 0};
}

std::optional<PolygonShape> ModelPrimitives::polygon(std::uint32_t primitive) const {
    if (is_triangle(primitive) || rows_[primitive].kind != ShapeKind::polygon) return std::nullopt;
    return part_->shapes->polygon(*part_->list, primitive);
}

Bounds ModelPrimitives::hit_bounds(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) {
        if (rows_[primitive].kind ==
            ShapeKind::polygon)  // the most frequent case, without a variant
            return lightwalk::hit_bounds(part_->shapes->polygon(*part_->list, primitive));
        return lightwalk::hit_bounds(part_->shapes->shape(*part_->list, primitive));
    }
    const TriangleRef ref = triangle(primitive);
    Bounds bounds;
    for (int i = 0; i < 3; ++i) bounds.extend(ref.corner(i));
    return bounds;
}

const SurfaceTraits& ModelPrimitives::traits(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return (*traits_)[part_->modifier(primitive)];
    const TriangleRef ref = triangle(primitive);
    const std::int32_t material = ref.triangle->material;
    return material < 0 ? ref.part->void_traits
                        : ref.part->traits[static_cast<std::size_t>(material)];
}

ModifierId ModelPrimitives::modifier(std::uint32_t primitive) const {
    if (!is_triangle(primitive)) return part_->modifier(primitive);
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
    std::size_t bytes = most_half_area_.capacity() * sizeof(double);
    for (const auto& [surface, edges] : large_polygons_)
        bytes += sizeof(surface) + edges.memory_bytes();
    return bytes;
}

}  // namespace lightwalk
