// The nodes of a glTF file: transformed meshes and lights.
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "core/math/transform.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_parts.h"

namespace lightwalk {
namespace {

constexpr double kLargestExtent = 1e20;  ///< of a coordinate [m]

/// From glTF's axes, y up, to Radiance's.
constexpr Matrix kUpright{{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}, Vec3{0, 0, 0}}};

double determinant(const Matrix& m) {
    return dot(cross(m.row[0], m.row[1]), m.row[2]);
}

Matrix rotation_of(const std::vector<double>& q) {
    const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(norm > 0) || !std::isfinite(norm)) return {};
    const double s = 2 / norm, x = q[0], y = q[1], z = q[2], w = q[3];
    return {{Vec3{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
             Vec3{s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
             Vec3{s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}, Vec3{}}};
}

/// The node's own transform: a matrix by columns, or scale, rotation and translation.
Matrix local_matrix(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        const std::vector<double>& m = node.matrix;
        return {{Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]},
                 Vec3{m[12], m[13], m[14]}}};
    }
    Matrix matrix;
    if (node.rotation.size() == 4) matrix = rotation_of(node.rotation);
    if (node.scale.size() == 3) {
        for (std::size_t axis = 0; axis < 3; ++axis) matrix.row[axis] *= node.scale[axis];
    }
    if (node.translation.size() == 3)
        matrix.row[3] = {node.translation[0], node.translation[1], node.translation[2]};
    return matrix;
}

/// The triangles of one material.
class PartBuilder {
  public:
    /// A primitive's vertices that are used get numbers in the part.
    class Vertices {
      public:
        Vertices(PartBuilder& part, const tinygltf::Model& model,
                 const tinygltf::Primitive& primitive, const GltfSurface& surface,
                 const Matrix& place, const std::string& name)
            : part_(part),
              surface_(surface),
              place_(place),
              name_(name),
              positions_(model, attribute(primitive, "POSITION"), 3, name) {
            if (const int normals = attribute(primitive, "NORMAL"); normals >= 0)
                normals_.emplace(model, normals, 3, name);
            const std::string uvs = "TEXCOORD_" + std::to_string(surface.uv_set);
            if (const int index = attribute(primitive, uvs); index >= 0)
                uvs_.emplace(model, index, 2, name);
            // Normals go by the inverse transposed, but for its length: rows' cross products.
            const double sign = determinant(place) < 0 ? -1 : 1;
            for (std::size_t i = 0; i < 3; ++i)
                for_normals_.row[i] = cross(place.row[(i + 1) % 3], place.row[(i + 2) % 3]) * sign;
            turned_ = sign < 0;
        }

        static int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
            const auto found = primitive.attributes.find(name);
            return found == primitive.attributes.end() ? -1 : found->second;
        }

        [[nodiscard]] std::size_t size() const { return positions_.size(); }
        /// What was read for them, in elements.
        [[nodiscard]] std::size_t cost() const {
            return 1 + positions_.replaced() + (normals_ ? normals_->replaced() : 0) +
                   (uvs_ ? uvs_->replaced() : 0);
        }

        void add(std::array<std::uint32_t, 3> corners) {
            if (turned_) std::swap(corners[1], corners[2]);
            MeshModel::Triangle triangle;
            triangle.has_normals = normals_.has_value();
            triangle.has_uvs = uvs_.has_value();
            for (std::size_t i = 0; i < 3; ++i) triangle.v[i] = vertex(corners[i], triangle);
            part_.add(triangle);
        }

      private:
        std::uint32_t vertex(std::uint32_t i, MeshModel::Triangle& triangle) {
            const auto next = static_cast<std::uint32_t>(part_.mesh_.positions.size());
            const auto [at, is_new] = numbers_.try_emplace(i, next);
            if (is_new) {
                if (i >= positions_.size())
                    throw InputError({name_, 0}, "index " + std::to_string(i) + " of a mesh of " +
                                                     std::to_string(positions_.size()) +
                                                     " vertices");
                add_vertex(i);
            }
            // A normal without a length smooths nothing.
            const MeshModel::Vertex& n = part_.mesh_.normals[at->second];
            if (n.x == 0 && n.y == 0 && n.z == 0) triangle.has_normals = false;
            return at->second;
        }

        void add_vertex(std::uint32_t i) {
            const auto vector = [i](const GltfAccessor& from) {
                return Vec3{from.at(i, 0), from.at(i, 1), from.at(i, 2)};
            };
            const Vec3 p = place_.point(vector(positions_));
            if (!(std::abs(p.x) <= kLargestExtent && std::abs(p.y) <= kLargestExtent &&
                  std::abs(p.z) <= kLargestExtent))
                throw InputError({name_, 0}, "a vertex is too far away, or no number");
            part_.mesh_.positions.push_back({p.x, p.y, p.z});
            Vec3 n;
            if (normals_ && i < normals_->size())
                n = normalize(for_normals_.vector(vector(*normals_)));
            if (!std::isfinite(n.x + n.y + n.z)) n = {};
            part_.mesh_.normals.push_back({n.x, n.y, n.z});
            std::array<double, 2> uv{};
            if (uvs_ && i < uvs_->size()) uv = transformed({uvs_->at(i, 0), uvs_->at(i, 1)});
            part_.mesh_.us.push_back(uv[0]);
            part_.mesh_.vs.push_back(1 - uv[1]);  // glTF's v goes down
        }

        /// KHR_texture_transform: scale, rotation, offset.
        [[nodiscard]] std::array<double, 2> transformed(std::array<double, 2> uv) const {
            const double u = uv[0] * surface_.uv_scale[0], v = uv[1] * surface_.uv_scale[1];
            const double c = std::cos(surface_.uv_rotation), s = std::sin(surface_.uv_rotation);
            return {c * u + s * v + surface_.uv_offset[0], c * v - s * u + surface_.uv_offset[1]};
        }

        PartBuilder& part_;
        const GltfSurface& surface_;
        const Matrix& place_;
        const std::string& name_;
        GltfAccessor positions_;
        std::optional<GltfAccessor> normals_, uvs_;
        Matrix for_normals_;
        bool turned_ = false;  ///< the transform mirrors
        std::unordered_map<std::uint32_t, std::uint32_t> numbers_;
    };

    std::shared_ptr<const MeshModel> release() {
        // What no triangle uses goes; the rest is flat where it says so.
        if (!any_normals_) mesh_.normals = {};
        if (!any_uvs_) {
            mesh_.us = {};
            mesh_.vs = {};
        }
        for (MeshModel::Vertex& n : mesh_.normals.own_values())
            if (n.x == 0 && n.y == 0 && n.z == 0) n = {0, 0, 1};
        mesh_.positions.trim();
        mesh_.normals.trim();
        mesh_.us.trim();
        mesh_.vs.trim();
        mesh_.triangles.trim();
        return std::make_shared<const MeshModel>(std::move(mesh_));
    }

  private:
    void add(const MeshModel::Triangle& triangle) {
        const auto position = [&](std::size_t i) {
            const MeshModel::Vertex& v = mesh_.positions[triangle.v[i]];
            return Vec3{v.x, v.y, v.z};
        };
        const Vec3 a = position(0);
        if (cross(position(1) - a, position(2) - a) == Vec3{}) return;
        any_normals_ = any_normals_ || triangle.has_normals;
        any_uvs_ = any_uvs_ || triangle.has_uvs;
        mesh_.triangles.push_back(triangle);
    }

    bool any_normals_ = false, any_uvs_ = false;
    MeshModel mesh_;
};

class NodeWalk {
  public:
    NodeWalk(const tinygltf::Model& model, const std::vector<GltfSurface>& surfaces,
             const std::string& name, std::size_t most_triangles, GltfFile& file)
        : model_(model),
          surfaces_(surfaces),
          name_(name),
          left_(most_triangles),
          file_(file),
          parts_(surfaces.size() + 1),
          visited_(model.nodes.size()) {}

    void run() {
        std::vector<std::pair<int, Matrix>> waiting;
        for (const int root : roots()) waiting.emplace_back(root, kUpright);
        while (!waiting.empty()) {
            const auto [index, above] = waiting.back();
            waiting.pop_back();
            const tinygltf::Node& node = visit(index);
            const Matrix place = local_matrix(node) * above;
            if (node.mesh != -1) add_mesh(node.mesh, place);
            add_light(node, place);
            if (node.skin != -1) skinned_ = true;
            for (const int child : node.children) waiting.emplace_back(child, place);
        }
        for (PartBuilder& part : parts_) file_.parts.push_back(part.release());
        if (skinned_)
            file_.left_out.emplace_back("skins are left out: their meshes are drawn as bound");
        if (lines_) file_.left_out.emplace_back("points and lines are left out");
        if (!model_.animations.empty()) file_.left_out.emplace_back("animations are left out");
    }

  private:
    /// The nodes of the scene, or those that are no other's child.
    [[nodiscard]] std::vector<int> roots() const {
        const int scene = model_.defaultScene == -1 ? 0 : model_.defaultScene;
        if (scene >= 0 && static_cast<std::size_t>(scene) < model_.scenes.size())
            return model_.scenes[static_cast<std::size_t>(scene)].nodes;
        if (!model_.scenes.empty())
            throw InputError({name_, 0}, "scene " + std::to_string(scene) +
                                             " does not exist, there are " +
                                             std::to_string(model_.scenes.size()));
        std::vector<bool> is_child(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes) {
            for (const int child : node.children) {
                if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                    is_child[static_cast<std::size_t>(child)] = true;
            }
        }
        std::vector<int> nodes;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) nodes.push_back(static_cast<int>(i));
        return nodes;
    }

    const tinygltf::Node& visit(int index) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
            throw InputError({name_, 0}, "node " + std::to_string(index) +
                                             " does not exist, there are " +
                                             std::to_string(model_.nodes.size()));
        const auto at = static_cast<std::size_t>(index);
        if (visited_[at])
            throw InputError({name_, 0}, "node " + std::to_string(index) +
                                             " is a child twice, or its own ancestor");
        visited_[at] = true;
        return model_.nodes[at];
    }

    void add_mesh(int index, const Matrix& place) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.meshes.size())
            throw InputError({name_, 0}, "mesh " + std::to_string(index) +
                                             " does not exist, there are " +
                                             std::to_string(model_.meshes.size()));
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(index)];
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            add_primitive(primitive, place);
    }

    void add_primitive(const tinygltf::Primitive& primitive, const Matrix& place) {
        const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            lines_ = true;
            return;
        }
        if (PartBuilder::Vertices::attribute(primitive, "POSITION") < 0) return;
        static const GltfSurface kPlain;
        const bool has_material = primitive.material != -1;
        const auto material = static_cast<std::size_t>(primitive.material);
        if (has_material && (primitive.material < 0 || material >= surfaces_.size()))
            throw InputError({name_, 0}, "material " + std::to_string(primitive.material) +
                                             " does not exist, there are " +
                                             std::to_string(surfaces_.size()));
        PartBuilder::Vertices vertices(has_material ? parts_[material] : parts_.back(), model_,
                                       primitive, has_material ? surfaces_[material] : kPlain,
                                       place, name_);
        charge(vertices.cost());
        if (primitive.indices < 0) {
            add_triangles(vertices, mode, vertices.size(),
                          [](std::size_t i) { return static_cast<std::uint32_t>(i); });
            return;
        }
        const GltfAccessor indices(model_, primitive.indices, 1, name_);
        charge(indices.replaced());
        add_triangles(vertices, mode, indices.size(),
                      [&indices](std::size_t i) { return indices.index(i); });
    }

    /// Nodes may repeat meshes, and meshes repeat accessors: what comes of it must have an end.
    void charge(std::size_t count) {
        if (count > left_)
            throw InputError({name_, 0}, "its nodes repeat meshes to too many triangles");
        left_ -= count;
    }

    void add_triangles(PartBuilder::Vertices& vertices, int mode, std::size_t corners,
                       FunctionRef<std::uint32_t(std::size_t)> corner) {
        const bool separate = mode == TINYGLTF_MODE_TRIANGLES;
        const std::size_t count =
            separate ? corners / 3 : corners - std::min<std::size_t>(corners, 2);
        charge(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (separate)
                vertices.add({corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)});
            else if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
                vertices.add({corner(i + 1), corner(i + 2), corner(0)});
            else
                vertices.add({corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)});
        }
    }

    void add_light(const tinygltf::Node& node, const Matrix& place) {
        const auto found = node.extensions.find("KHR_lights_punctual");
        if (found == node.extensions.end() || !found->second.IsObject()) return;
        const double index = gltf_number(found->second, "light", -1);
        if (!(index >= 0 && index < static_cast<double>(model_.lights.size())))
            throw InputError({name_, 0}, "a light does not exist, there are " +
                                             std::to_string(model_.lights.size()));
        const tinygltf::Light& from = model_.lights[static_cast<std::size_t>(index)];
        GltfLight light;
        if (from.type == "directional")
            light.kind = GltfLight::Kind::directional;
        else if (from.type == "spot")
            light.kind = GltfLight::Kind::spot;
        for (std::size_t c = 0; c < 3; ++c) {
            const double color = from.color.size() >= 3 ? from.color[c] : 1;
            light.intensity[c] = std::max(color * from.intensity, 0.0);
            if (!(light.intensity[c] <= kLargestExtent)) return;
        }
        light.position = place.row[3];
        light.direction = normalize(place.vector({0, 0, -1}));
        light.angle = from.spot.outerConeAngle;
        const double sum = light.position.x + light.position.y + light.position.z;
        if (!(std::abs(sum) <= kLargestExtent) || light.direction == Vec3{}) return;
        if (!(light.angle > 0 && light.angle <= kPi)) light.angle = kPi / 4;
        file_.lights.push_back(light);
    }

    const tinygltf::Model& model_;
    const std::vector<GltfSurface>& surfaces_;
    const std::string& name_;
    std::size_t left_;  ///< triangles that may follow
    GltfFile& file_;
    std::vector<PartBuilder> parts_;
    std::vector<bool> visited_;
    bool skinned_ = false, lines_ = false;
};

}  // namespace

void add_gltf_nodes(const tinygltf::Model& model, const std::vector<GltfSurface>& surfaces,
                    const std::string& name, std::size_t most_triangles, GltfFile& file) {
    NodeWalk(model, surfaces, name, most_triangles, file).run();
}

}  // namespace lightwalk
