#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/math/direction_code.h"
#include "core/math/vec3.h"
#include "io/formats/binary_reader.h"
#include "io/formats/header.h"
#include "io/scene/binary_models.h"
#include "io/scene/binary_objects.h"

namespace lightwalk {
namespace {

constexpr std::int64_t kMeshMagic = 319;
constexpr std::uint32_t kPatchSize = 256;
constexpr std::int64_t kMostPatches = std::int64_t{1} << 24;  ///< limit of 32-bit vertex ids
constexpr std::int64_t kMostLocalTriangles = 512, kMostJoiners = 256;
constexpr unsigned kHasPositions = 1, kHasNormals = 2, kHasUvs = 4;

/// Where the vertices of a patch lie in the model, and what they carry.
struct Patch {
    std::uint32_t first = 0, count = 0;
};

/// A coordinate code c stands for the middle of its cell, (c + 0.5) / 2^32 of the range.
double fraction_of(std::uint64_t code) {
    return (static_cast<double>(code) + 0.5) / 4294967296.0;
}

class MeshDecoder {
    using Triangle = MeshModel::Triangle;

  public:
    MeshDecoder(std::string_view bytes, const std::string& name) : reader_(bytes, name, "mesh") {}

    MeshModel decode() {
        const std::int64_t id_size = reader_.integer(2) - kMeshMagic;
        if (id_size < 1 || id_size > 8) reader_.fail("incompatible mesh format");
        cube_ = read_cube(reader_);
        if (!(cube_.size > kEpsilon)) reader_.fail("illegal bounds in mesh");
        for (double& limit : uv_range_) limit = reader_.real();
        skip_tree(reader_, static_cast<int>(id_size));
        read_materials(static_cast<int>(id_size));
        const std::int64_t patches = reader_.integer(4);
        if (patches < 0) reader_.fail("negative number of patches");
        if (patches > kMostPatches) reader_.fail("too many patches");
        const std::size_t bytes = reader_.remaining();
        for (std::int64_t i = 0; i < patches; ++i) {
            read_patch(static_cast<std::uint32_t>(i));
            if (i == 0) expect_like_first(static_cast<std::size_t>(patches), bytes);
        }
        for (Triangle& triangle : mesh_.triangles.own_values()) resolve_corners(triangle);
        drop_unused_tables();
        trim();
        return std::move(mesh_);
    }

  private:
    void read_materials(int id_size) {
        ModelBuilder builder;
        read_objects(reader_, id_size, builder);
        if (!builder.model().surfaces.empty())
            reader_.fail("non-modifier \"" + std::string(builder.model().surfaces[0].name) +
                         "\" in mesh");
        mesh_.materials = std::move(*builder.release());
    }

    void read_patch(std::uint32_t number) {
        const auto flags = static_cast<unsigned>(reader_.unsigned_integer(1));
        if ((flags & kHasPositions) == 0 || flags > (kHasPositions | kHasNormals | kHasUvs)) {
            reader_.fail("bad flags of patch " + std::to_string(number));
        }
        const std::int64_t vertices = reader_.integer(2);
        if (vertices < 1 || vertices > static_cast<std::int64_t>(kPatchSize)) {
            reader_.fail("bad number of vertices: " + std::to_string(vertices));
        }
        if (mesh_.positions.size() > std::numeric_limits<std::uint32_t>::max() - kPatchSize) {
            reader_.fail("too many vertices");
        }
        patches_.push_back({static_cast<std::uint32_t>(mesh_.positions.size()),
                            static_cast<std::uint32_t>(vertices)});
        read_positions(vertices);
        read_normals(vertices, (flags & kHasNormals) != 0);
        read_uvs(vertices, (flags & kHasUvs) != 0);
        read_local_triangles(number);
        read_single_joiners(number);
        read_double_joiners(number);
    }

    /// Patches are mostly as large as the first: arrays that grow side by side would leave the
    /// holes of all their steps behind. No more than the file's bytes can hold.
    void expect_like_first(std::size_t patches, std::size_t bytes) {
        const std::size_t first = bytes - reader_.remaining(),
                          count = std::min(patches, bytes / first + 1);
        const auto reserve = [&](auto& column) { column.reserve(column.size() * count); };
        reserve(mesh_.positions);
        reserve(mesh_.normals);
        reserve(mesh_.us);
        reserve(mesh_.vs);
        reserve(mesh_.triangles);
    }

    void read_positions(std::int64_t count) {
        reader_.expect(static_cast<std::uint64_t>(count), 12);
        for (std::int64_t i = 0; i < count; ++i) {
            MeshModel::Vertex p;
            p.x = cube_.x + fraction_of(reader_.unsigned_integer(4)) * cube_.size;
            p.y = cube_.y + fraction_of(reader_.unsigned_integer(4)) * cube_.size;
            p.z = cube_.z + fraction_of(reader_.unsigned_integer(4)) * cube_.size;
            mesh_.positions.push_back(p);
        }
    }

    void read_normals(std::int64_t count, bool present) {
        for (std::int64_t i = 0; i < count; ++i) {
            const auto code = present ? static_cast<std::uint32_t>(reader_.unsigned_integer(4)) : 0;
            const Vec3 n = decode_direction(code);
            mesh_.normals.push_back({n.x, n.y, n.z});
            has_normal_.push_back(code != 0);
        }
    }

    void read_uvs(std::int64_t count, bool present) {
        if (present && !(uv_range_[1] > uv_range_[0] && uv_range_[3] > uv_range_[2])) {
            reader_.fail("texture coordinates with an empty range");
        }
        for (std::int64_t i = 0; i < count; ++i) {
            const std::uint64_t u = present ? reader_.unsigned_integer(4) : 0;
            const std::uint64_t v = present ? reader_.unsigned_integer(4) : 0;
            has_uv_.push_back(u != 0);
            const bool real = u != 0;
            mesh_.us.push_back(real ? at_fraction(uv_range_[0], uv_range_[1], u) : 0);
            mesh_.vs.push_back(real ? at_fraction(uv_range_[2], uv_range_[3], v) : 0);
        }
    }

    static double at_fraction(double low, double high, std::uint64_t code) {
        return low + (high - low) * fraction_of(code);
    }

    std::int64_t read_bounded(std::int64_t most, const char* what) {
        const std::int64_t count = reader_.integer(2);
        if (count < 0 || count > most) {
            reader_.fail("bad number of " + std::string(what) + ": " + std::to_string(count));
        }
        return count;
    }

    /// A vertex id: patch · 256 + index.
    std::uint32_t read_id() { return static_cast<std::uint32_t>(reader_.unsigned_integer(4)); }
    std::uint32_t read_corner(std::uint32_t patch) {
        return patch * kPatchSize + static_cast<std::uint32_t>(reader_.unsigned_integer(1));
    }

    std::int32_t read_material() { return static_cast<std::int32_t>(reader_.integer(2)); }

    void read_local_triangles(std::uint32_t patch) {
        const std::int64_t count = read_bounded(kMostLocalTriangles, "triangles");
        const std::size_t first = mesh_.triangles.size();
        for (std::int64_t i = 0; i < count; ++i) {
            Triangle triangle;
            for (std::uint32_t& corner : triangle.v) corner = read_corner(patch);
            mesh_.triangles.push_back(triangle);
        }
        const std::int64_t materials = reader_.integer(2);
        const std::int32_t common = materials > 1 ? kVoidIndex : read_material();
        for (Triangle& triangle : mesh_.triangles.own_values().subspan(first))
            triangle.material = materials > 1 ? read_material() : common;
    }

    void read_single_joiners(std::uint32_t patch) {
        const std::int64_t count = read_bounded(kMostJoiners, "joining triangles");
        for (std::int64_t i = 0; i < count; ++i) {
            Triangle triangle;
            triangle.v[0] = read_id();
            triangle.v[1] = read_corner(patch);
            triangle.v[2] = read_corner(patch);
            triangle.material = read_material();
            mesh_.triangles.push_back(triangle);
        }
    }

    void read_double_joiners(std::uint32_t patch) {
        const std::int64_t count = read_bounded(kMostJoiners, "joining triangles");
        for (std::int64_t i = 0; i < count; ++i) {
            Triangle triangle;
            triangle.v[0] = read_id();
            triangle.v[1] = read_id();
            triangle.v[2] = read_corner(patch);
            triangle.material = read_material();
            mesh_.triangles.push_back(triangle);
        }
    }

    std::uint32_t vertex_index(std::uint32_t id) const {
        const std::uint32_t patch = id / kPatchSize, local = id % kPatchSize;
        if (patch >= patches_.size() || local >= patches_[patch].count) {
            reader_.fail("triangle corner " + std::to_string(id) + " does not exist");
        }
        return patches_[patch].first + local;
    }

    std::int32_t material_index(std::int32_t number) const {
        const std::size_t count = mesh_.materials.modifiers.size();
        if (count == 0) return kVoidIndex;
        if (number < 0 || static_cast<std::size_t>(number) >= count) {
            reader_.fail("bad triangle material " + std::to_string(number));
        }
        return number;
    }

    /// Once all patches are read: until then a triangle's corners are vertex ids.
    void resolve_corners(Triangle& triangle) {
        triangle.material = material_index(triangle.material);
        triangle.has_normals = triangle.has_uvs = true;
        for (std::uint32_t& corner : triangle.v) {
            corner = vertex_index(corner);
            triangle.has_normals = triangle.has_normals && has_normal_[corner];
            triangle.has_uvs = triangle.has_uvs && has_uv_[corner];
        }
        any_normals_ = any_normals_ || triangle.has_normals;
        any_uvs_ = any_uvs_ || triangle.has_uvs;
    }

    void drop_unused_tables() {
        if (!any_normals_) mesh_.normals = {};
        if (any_uvs_) return;
        mesh_.us = {};
        mesh_.vs = {};
    }

    /// Gives back what growing has taken in advance.
    void trim() {
        mesh_.positions.trim();
        mesh_.normals.trim();
        mesh_.us.trim();
        mesh_.vs.trim();
        mesh_.triangles.trim();
    }

    BinaryReader reader_;
    ModelCube cube_;
    std::array<double, 4> uv_range_{};  ///< u_min, u_max, v_min, v_max
    std::vector<Patch> patches_;
    std::vector<bool> has_normal_, has_uv_;
    bool any_normals_ = false, any_uvs_ = false;
    MeshModel mesh_;
};

}  // namespace

MeshModel decode_mesh(std::string_view bytes, const std::string& name) {
    const InfoHeader header = decode_header(bytes, name);
    return MeshDecoder(bytes.substr(header.size), name).decode();
}

}  // namespace lightwalk
