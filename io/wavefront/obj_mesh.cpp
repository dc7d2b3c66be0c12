#include "io/wavefront/obj_mesh.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lightwalk {
namespace {

struct CornerHash {
    std::size_t operator()(const ObjFile::Corner& c) const noexcept {
        std::uint64_t h = c.position;
        h = h * 0x9e3779b97f4a7c15u + c.uv;
        h = h * 0x9e3779b97f4a7c15u + c.normal;
        return static_cast<std::size_t>(h ^ (h >> 32));
    }
};

class ObjMesh {
  public:
    ObjMesh(const ObjFile& file, Model materials) : file_(file) {
        mesh_.materials = std::move(materials);
        for (std::size_t i = 0; i < mesh_.materials.modifiers.size(); ++i)
            numbers_[mesh_.materials.modifiers[i].name] = static_cast<std::int32_t>(i);
    }

    void add(const ObjFile::Face& face) {
        const std::span<const ObjFile::Corner> corners = file_.corners_of(face);
        const auto material = numbers_.find(file_.material_of(face));
        for (const ObjTriangle& places : triangulate(file_, face, 0)) {
            MeshModel::Triangle triangle;
            triangle.material = material == numbers_.end() ? kVoidIndex : material->second;
            triangle.has_normals = triangle.has_uvs = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const ObjFile::Corner& corner = corners[places[i]];
                triangle.v[i] = vertex_of(corner);
                triangle.has_normals = triangle.has_normals && corner.normal != ObjFile::kNone;
                triangle.has_uvs = triangle.has_uvs && corner.uv != ObjFile::kNone;
            }
            any_normals_ = any_normals_ || triangle.has_normals;
            any_uvs_ = any_uvs_ || triangle.has_uvs;
            mesh_.triangles.push_back(triangle);
        }
    }

    MeshModel release() {
        if (!any_normals_) mesh_.normals = {};
        if (!any_uvs_) {
            mesh_.us = {};
            mesh_.vs = {};
        }
        mesh_.positions.trim();
        mesh_.normals.trim();
        mesh_.us.trim();
        mesh_.vs.trim();
        mesh_.triangles.trim();
        return std::move(mesh_);
    }

  private:
    std::uint32_t vertex_of(const ObjFile::Corner& corner) {
        const auto [at, is_new] =
            vertices_.try_emplace(corner, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (!is_new) return at->second;
        const Vec3& p = file_.positions[corner.position];
        mesh_.positions.push_back({p.x, p.y, p.z});
        const bool has_normal = corner.normal != ObjFile::kNone;
        const Vec3 n = has_normal ? file_.normals[corner.normal] : Vec3{0, 0, 1};
        mesh_.normals.push_back({n.x, n.y, n.z});
        const bool has_uv = corner.uv != ObjFile::kNone;
        mesh_.us.push_back(has_uv ? file_.uvs[corner.uv][0] : 0);
        mesh_.vs.push_back(has_uv ? file_.uvs[corner.uv][1] : 0);
        return at->second;
    }

    const ObjFile& file_;
    std::unordered_map<std::string, std::int32_t> numbers_;  ///< of the materials
    std::unordered_map<ObjFile::Corner, std::uint32_t, CornerHash> vertices_;
    bool any_normals_ = false, any_uvs_ = false;
    MeshModel mesh_;
};

}  // namespace

MeshModel mesh_of_obj(const ObjFile& file, const std::optional<std::string>& material,
                      Model materials) {
    ObjMesh mesh(file, std::move(materials));
    for (const ObjFile::Face& face : file.faces) {
        if (!material || file.material_of(face) == *material) mesh.add(face);
    }
    return mesh.release();
}

}  // namespace lightwalk
