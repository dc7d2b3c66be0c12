#include "io/generators/polygon_mesh.h"

#include <cmath>

#include "core/error.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

void append_values(std::string& line, std::span<const double> values) {
    for (const double value : values) {
        if (!std::isfinite(value)) throw InputError("a vertex is not a finite point");
        line += " " + general(value, kFullDigits);
    }
    line += "\n";
}

std::array<double, 3> values_of(const Vec3& v) {
    return {v.x, v.y, v.z};
}

/// "-2", "-2/-2", "-2//-2" or "-2/-2/-2".
std::string face_vertex(const PolygonMesh& mesh, std::size_t vertex) {
    const std::string index = "-" + std::to_string(mesh.positions.size() - vertex);
    if (mesh.uvs.empty()) return mesh.normals.empty() ? index : index + "//" + index;
    return index + "/" + index + (mesh.normals.empty() ? "" : "/" + index);
}

}  // namespace

std::string write_obj(std::span<const std::string> args, const std::string& material,
                      const std::string& name, const PolygonMesh& mesh) {
    SceneWriter out(args);
    out.text("usemtl " + material + "\no " + name + "\n");
    std::string line;
    const auto flush = [&] {
        out.text(line);
        line.clear();
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        line = "v";
        append_values(line, values_of(mesh.positions[i]));
        if (!mesh.uvs.empty()) append_values(line += "vt", mesh.uvs[i]);
        if (!mesh.normals.empty()) append_values(line += "vn", values_of(mesh.normals[i]));
        flush();
    }
    for (const PolygonMesh::Face& face : mesh.faces) {
        line = "f";
        for (std::size_t i = 0; i < face.corners; ++i)
            line += " " + face_vertex(mesh, face.vertex[i]);
        line += "\n";
        flush();
    }
    return out.release();
}

}  // namespace lightwalk
