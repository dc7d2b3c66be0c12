// gensurf: a surface given by functions of two parameters, or by tables. See Radiance's manual page
// gensurf(1).
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/generators/expressions.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/polygon_mesh.h"
#include "io/generators/scene_writer.h"
#include "io/generators/surface_data.h"
#include "io/generators/surface_grid.h"
#include "io/generators/vertex_rows.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGensurfUsage =
    "material name x(s,t) y(s,t) z(s,t) m n [-e expression] [-f file] [-s] [-i] [-o]";
constexpr std::size_t kMaxTableBytes = std::size_t{256} << 20;
constexpr double kFlat = 1e-12;  ///< 1 minus the cosine between triangles that make one polygon

struct SurfaceOptions {
    std::string material, name;
    std::array<std::string, 3> coordinate;  ///< expressions; the last or all may name a table
    std::size_t m = 0, n = 0;
    bool smooth = false, inverted = false, obj = false;
};

/// Where points come from.
class Surface {
  public:
    Surface(const SurfaceOptions& options, GeneratorExpressions& expressions,
            const std::string& program, GeneratorContext& context)
        : program_(program), expressions_(expressions) {
        const std::array<std::string, 3> names = {"X`SYS", "Y`SYS", "Z`SYS"};
        table_begin_ = first_table(options, context);
        if (table_begin_ < 3) {
            const std::string& file = options.coordinate[2];
            const std::string text = file == "-"
                                         ? context.standard_input()
                                         : context.library.files().read(
                                               path_from(context.directory, file), kMaxTableBytes);
            table_.emplace(text, file == "-" ? "standard input" : file, options.m, options.n,
                           3 - table_begin_);
        }
        std::vector<std::string> used(names.begin(), names.begin() + table_begin_);
        for (std::size_t i = 0; i < used.size(); ++i) {
            expressions.define_function(program, used[i], "s,t", options.coordinate[i]);
        }
        has_valid_ = expressions.parameters("valid") == 2;
        if (has_valid_) used.emplace_back("valid");
        functions_.emplace(expressions.compile_program(program, used, 2));
    }

    std::optional<Vec3> operator()(double s, double t) {
        const std::array<double, 2> st = {s, t};
        const auto expressions = static_cast<std::size_t>(table_begin_);
        if (has_valid_ && !((*functions_)(expressions, st) > 0)) return std::nullopt;
        Vec3 p;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = i < expressions ? (*functions_)(i, st) : table_->value(i - expressions, s, t);
        }
        if (!std::isfinite(p.x + p.y + p.z)) {
            throw InputError(program_ + ": the surface is not finite at s=" + general(s, 6) +
                             ", t=" + general(t, 6));
        }
        return p;
    }

    void report() const { expressions_.report(program_, *functions_); }

  private:
    /// The first coordinate that is a table: 0, 2, or 3 for none.
    static int first_table(const SurfaceOptions& options, const GeneratorContext& context) {
        const std::string& file = options.coordinate[2];
        if (file != "-" && !context.library.files().readable(path_from(context.directory, file)))
            return 3;
        const bool all = options.coordinate[0] == file && options.coordinate[1] == file;
        return all ? 0 : 2;
    }

    const std::string& program_;
    GeneratorExpressions& expressions_;
    int table_begin_ = 3;
    bool has_valid_ = false;
    std::optional<SurfaceData> table_;
    std::optional<CompiledFunctions> functions_;
};

SurfaceOptions parse(GeneratorWords& words, GeneratorExpressions& expressions) {
    SurfaceOptions options;
    options.material = words.text("material");
    options.name = words.text("name");
    for (std::string& coordinate : options.coordinate) coordinate = words.text("coordinate");
    const std::string m = words.text("m");
    const std::string n = words.text("n");
    while (!words.at_end()) {
        if (expressions.accept_option(words)) continue;
        if (words.accept("-s"))
            options.smooth = true;
        else if (words.accept("-i"))
            options.inverted = true;
        else if (words.accept("-o"))
            options.obj = true;
        else
            words.unknown_option();
    }
    options.m = expressions.count(words, m, "m", kMaxPieces);
    options.n = expressions.count(words, n, "n", kMaxPieces);
    // With the border; a smoothed piece is several times as long as a flat one.
    const std::size_t most = options.smooth ? kMaxPieces / 4 : 2 * kMaxPieces;
    if ((options.m + 3) * (options.n + 3) > most) words.fail("m times n is too large");
    return options;
}

/// Writes the cells of a grid, or collects them as a mesh.
class CellWriter {
  public:
    CellWriter(const SurfaceOptions& options, const SurfaceGrid& grid)
        : options_(options), grid_(grid) {
        if (!options.smooth) return;
        normals_ = grid.normals();
        if (options.inverted) {
            for (Vec3& normal : normals_) normal = -normal;
        }
    }

    void write_scene(SceneWriter& out) {
        VertexRows rows(grid_);
        for_each_piece(
            [&](const SurfaceCell& cell, std::span<const std::size_t> corners, const Vec3& flat) {
                std::array<std::string_view, 4> vertices;
                for (std::size_t i = 0; i < corners.size(); ++i)
                    vertices[i] = rows.text(cell.p[corners[i]].i, cell.p[corners[i]].j);
                const bool smoothed = options_.smooth && write_texture(cell, flat, out);
                out.polygon(smoothed ? std::string_view("Phong") : options_.material,
                            options_.name + "." + std::to_string(++pieces_),
                            std::span<const std::string_view>(vertices.data(), corners.size()));
            });
    }

    [[nodiscard]] PolygonMesh mesh() {
        PolygonMesh mesh;
        std::vector<std::uint32_t> vertex_of;
        for (std::size_t i = 0; i <= grid_.m(); ++i) {
            for (std::size_t j = 0; j <= grid_.n(); ++j) {
                vertex_of.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                if (!grid_.valid(i, j)) continue;
                mesh.positions.push_back(grid_.point(i, j));
                mesh.uvs.push_back({static_cast<double>(i) / static_cast<double>(grid_.m()),
                                    static_cast<double>(j) / static_cast<double>(grid_.n())});
                if (options_.smooth) mesh.normals.push_back(normals_[index(i, j)]);
            }
        }
        for_each_piece([&](const SurfaceCell& cell, std::span<const std::size_t> corners,
                           const Vec3&) {
            PolygonMesh::Face face;
            for (const std::size_t corner : corners) {
                face.vertex[face.corners++] = vertex_of[index(cell.p[corner].i, cell.p[corner].j)];
            }
            mesh.faces.push_back(face);
        });
        return mesh;
    }

  private:
    [[nodiscard]] std::size_t index(std::size_t i, std::size_t j) const {
        return i * (grid_.n() + 1) + j;
    }
    [[nodiscard]] const Vec3& point(const SurfaceCell& cell, std::size_t corner) const {
        return grid_.point(cell.p[corner].i, cell.p[corner].j);
    }
    /// Unit normal of a triangle of valid corners; nothing when it has no area.
    [[nodiscard]] std::optional<Vec3> triangle_normal(const SurfaceCell& cell, std::size_t a,
                                                      std::size_t b, std::size_t c) const {
        for (const std::size_t corner : {a, b, c}) {
            if (!grid_.valid(cell.p[corner].i, cell.p[corner].j)) return std::nullopt;
        }
        const Vec3 p = point(cell, a);
        const Vec3 normal = normalize(cross(point(cell, b) - p, point(cell, c) - p));
        if (normal == Vec3{}) return std::nullopt;
        return normal;
    }

    /// Call piece(cell, corners, normal) for every polygon.
    template <class Piece>
    void for_each_piece(const Piece& piece) const {
        constexpr std::array<std::size_t, 3> kFirst = {0, 1, 2};
        constexpr std::array<std::size_t, 3> kSecond = {2, 1, 3};
        constexpr std::array<std::size_t, 4> kBoth = {0, 1, 3, 2};
        for (std::size_t i = 0; i < grid_.m(); ++i) {
            for (std::size_t j = 0; j < grid_.n(); ++j) {
                SurfaceCell cell = surface_cell(grid_, i, j);
                if (options_.inverted) std::swap(cell.p[1], cell.p[2]);
                const auto n1 = triangle_normal(cell, 0, 1, 2);
                const auto n2 = triangle_normal(cell, 2, 1, 3);
                if (n1 && n2 && dot(*n1, *n2) >= 1 - kFlat) {
                    piece(cell, kBoth, (*n1 + *n2) * 0.5);
                    continue;
                }
                if (n1) piece(cell, kFirst, *n1);
                if (n2) piece(cell, kSecond, *n2);
            }
        }
    }

    /// The texture that bends the flat normal to the surface's; false when the cell determines
    /// none.
    bool write_texture(const SurfaceCell& cell, const Vec3& flat, SceneWriter& out) const {
        std::array<Vec3, 4> points;
        std::array<Vec3, 4> corner_normals;
        for (std::size_t k = 0; k < 4; ++k) {
            points[k] = point(cell, k);
            corner_normals[k] = normals_[index(cell.p[k].i, cell.p[k].j)];
        }
        std::optional<NormalFit> fit = fit_normals(points, corner_normals);
        if (!fit) return false;
        fit->c[3] -= flat;
        std::array<double, 13> reals{static_cast<double>(fit->axis)};
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) reals[1 + 3 * k + axis] = fit->c[k][axis];
        }
        const std::array<std::string, 4> strings = {"surf_dx", "surf_dy", "surf_dz", "surf.cal"};
        out.write(options_.material, "texfunc", "Phong", reals, strings);
        return true;
    }

    const SurfaceOptions& options_;
    const SurfaceGrid& grid_;
    std::vector<Vec3> normals_;
    std::size_t pieces_ = 0;
};

/// Whether each polygon is read as one. A material that begins a comment or a command makes another
/// text of them, which nothing may cut.
bool reads_as_polygons(const SurfaceOptions& options) {
    return !options.material.starts_with('#') && !options.material.starts_with('!');
}

}  // namespace

std::string run_gensurf(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kGensurfUsage);
    GeneratorExpressions expressions(context);
    const SurfaceOptions options = parse(words, expressions);
    Surface surface(options, expressions, words.program(), context);
    const SurfaceGrid grid(options.m, options.n, options.smooth,
                           [&surface](double s, double t) { return surface(s, t); });
    surface.report();
    CellWriter cells(options, grid);
    if (options.obj) return write_obj(args, options.material, options.name, cells.mesh());
    SceneWriter out(args, reads_as_polygons(options) ? context.output : nullptr);
    cells.write_scene(out);
    return out.release();
}

}  // namespace lightwalk
