#include "io/scene/frozen_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "io/formats/packed.h"

namespace lightwalk {
namespace {

[[noreturn]] void refuse_column(const FrozenFile& file, const char* what) {
    throw InputError({file.name(), 0}, std::string("damaged: ") + what);
}

/// Checks that the bool at `offset` of each value is 0 or 1, as other bytes are undefined
/// behaviour.
template <class T>
void check_bools(const FrozenFile& file, std::span<const T> values, std::size_t offset) {
    const auto* byte = reinterpret_cast<const unsigned char*>(values.data()) + offset;
    for (std::size_t i = 0; i < values.size(); ++i, byte += sizeof(T)) {
        if (*byte > 1) refuse_column(file, "a flag that is neither 0 nor 1");
    }
}

/// Names of files, each once, by number.
class FileNumbers {
  public:
    std::int32_t number(const FileName& file) {
        if (!last_.is(file) || numbers_.empty()) {
            const auto next = static_cast<std::int32_t>(names.size());
            const auto [found, is_new] = numbers_.try_emplace(file.text(), next);
            if (is_new) names.push_back(found->first);
            last_ = file;
            last_number_ = found->second;
        }
        return last_number_;
    }
    std::vector<std::string> names;

  private:
    std::map<std::string, std::int32_t> numbers_;
    FileName last_;
    std::int32_t last_number_ = 0;
};

void pack_modifiers(PackedWriter& writer, std::span<const Primitive> modifiers) {
    FileNumbers files;
    for (const Primitive& modifier : modifiers) (void)files.number(modifier.where.file);
    writer.texts(files.names);
    writer.count(modifiers.size());
    for (const Primitive& modifier : modifiers) {
        writer.number(modifier.type);
        writer.number(modifier.modifier);
        writer.text(modifier.name);
        writer.texts(modifier.strings);
        writer.list(modifier.reals);
        writer.list(modifier.references);
        writer.number(files.number(modifier.where.file));
        writer.number(modifier.where.line);
    }
}

constexpr std::size_t kLeastModifier = 1 + 4 + 4 * 8 + 4 + 4;  ///< packed [bytes]

std::vector<FileName> unpack_files(PackedReader& reader) {
    std::vector<FileName> files;
    for (const std::string& name : reader.texts()) files.emplace_back(name);
    return files;
}

std::vector<Primitive> unpack_modifiers(PackedReader& reader) {
    const std::vector<FileName> files = unpack_files(reader);
    std::vector<Primitive> modifiers(reader.count(kLeastModifier));
    for (std::size_t i = 0; i < modifiers.size(); ++i) {
        Primitive& modifier = modifiers[i];
        modifier.type = reader.number<PrimitiveType>();
        modifier.modifier = reader.number<std::int32_t>();
        modifier.name = reader.text();
        modifier.strings = reader.texts();
        modifier.reals = reader.list<double>();
        modifier.references = reader.list<std::int32_t>();
        const auto file = reader.number<std::uint32_t>();
        if (!is_sound_modifier(modifier, i) || file >= files.size()) reader.fail();
        modifier.where = {files[file], reader.number<std::int32_t>()};
    }
    return modifiers;
}

void pack_cube(PackedWriter& writer, const std::optional<ModelCube>& cube) {
    writer.boolean(cube.has_value());
    const ModelCube c = cube.value_or(ModelCube());
    for (const double number : {c.x, c.y, c.z, c.size}) writer.number(number);
    writer.boolean(c.holds_all);
}

std::optional<ModelCube> unpack_cube(PackedReader& reader) {
    const bool present = reader.boolean();
    ModelCube cube;
    for (double* number : {&cube.x, &cube.y, &cube.z, &cube.size})
        *number = reader.number<double>();
    cube.holds_all = reader.boolean();
    if (!std::isfinite(cube.x + cube.y + cube.z) || !std::isfinite(cube.size) || cube.size < 0)
        reader.fail();
    return present ? std::optional(cube) : std::nullopt;
}

void pack_skies(PackedWriter& writer, const std::vector<GeneratedPart>& skies) {
    writer.count(skies.size());
    for (const GeneratedPart& sky : skies) {
        writer.text(sky.where.file.text());
        writer.number(sky.where.line);
        writer.text(sky.command);
        writer.text(sky.refusal);
        writer.number(sky.first_modifier);
        writer.number(sky.last_modifier);
        writer.count(sky.first_surface);
        writer.count(sky.last_surface);
    }
}

constexpr std::size_t kLeastSky = 3 * 8 + 4 + 2 * 4 + 2 * 8;  ///< packed [bytes]

std::vector<GeneratedPart> unpack_skies(PackedReader& reader) {
    std::vector<GeneratedPart> skies(reader.count(kLeastSky));
    for (GeneratedPart& sky : skies) {
        sky.where.file = FileName(reader.text());
        sky.where.line = reader.number<std::int32_t>();
        sky.command = reader.text();
        sky.refusal = reader.text();
        sky.first_modifier = reader.number<std::int32_t>();
        sky.last_modifier = reader.number<std::int32_t>();
        sky.first_surface = reader.number<std::uint64_t>();
        sky.last_surface = reader.number<std::uint64_t>();
    }
    return skies;
}

/// Checks that a sky is a part of its model.
bool is_sound(const GeneratedPart& sky, const Model& model) {
    return sky.first_modifier >= 0 && sky.first_modifier <= sky.last_modifier &&
           static_cast<std::size_t>(sky.last_modifier) <= model.modifiers.size() &&
           sky.first_surface <= sky.last_surface && sky.last_surface <= model.surfaces.size();
}

SurfaceList map_surfaces(const FrozenFile& file, std::uint32_t number, std::vector<FileName> files,
                         std::size_t modifiers) {
    SurfaceList::Columns columns;
    columns.records = column_of<SurfaceRecord>(file, FrozenKind::records, number);
    columns.reals = column_of<double>(file, FrozenKind::reals, number);
    columns.corners = column_of<std::uint32_t>(file, FrozenKind::corners, number);
    columns.text = column_of<char>(file, FrozenKind::text, number);
    columns.strings = column_of<SurfaceStrings>(file, FrozenKind::strings, number);
    columns.files = std::move(files);
    return {std::move(columns), modifiers};
}

bool within_reach(double x) {
    return std::abs(x) <= kLargestCoordinate;
}
bool within_reach(const Vec3& v) {
    return within_reach(v.x) && within_reach(v.y) && within_reach(v.z);
}
bool is_usable(const SphereShape& sphere) {
    return within_reach(sphere.center) && sphere.radius > 0 && within_reach(sphere.radius);
}
bool is_usable(const ConeShape& cone) {
    return within_reach(cone.p0) && within_reach(cone.p1) && within_reach(cone.axis) &&
           cone.r0 >= 0 && cone.r1 >= cone.r0 && within_reach(cone.r1) && cone.length > 0 &&
           within_reach(cone.length) && std::isfinite(cone.slope);
}
bool is_usable(const RingShape& ring) {
    return within_reach(ring.center) && within_reach(ring.normal) && ring.r0 >= 0 &&
           ring.r1 >= ring.r0 && within_reach(ring.r1);
}
bool is_usable(const SourceShape& source) {
    return within_reach(source.direction) && std::isfinite(source.solid_angle);
}

/// Checks that the shapes to which rows refer have numbers that the search can handle.
void check_shapes(const FrozenFile& file, const SurfaceShapes::Columns& columns) {
    for (const ShapeRow& row : columns.rows) {
        const auto usable = [&](const auto& column) {
            return row.index() < column.size() && is_usable(column[row.index()]);
        };
        const bool good = row.kind == ShapeKind::sphere   ? usable(columns.spheres)
                          : row.kind == ShapeKind::cone   ? usable(columns.cones)
                          : row.kind == ShapeKind::ring   ? usable(columns.rings)
                          : row.kind == ShapeKind::source ? usable(columns.sources)
                                                          : true;
        if (!good) refuse_column(file, "an unknown kind of shape");
    }
}

SurfaceShapes map_shapes(const FrozenFile& file, std::uint32_t number, const SurfaceList& list,
                         std::vector<std::string> warnings) {
    SurfaceShapes::Columns columns;
    columns.rows = column_of<ShapeRow>(file, FrozenKind::rows, number);
    columns.spheres = column_of<SphereShape>(file, FrozenKind::spheres, number);
    columns.cones = column_of<ConeShape>(file, FrozenKind::cones, number);
    columns.rings = column_of<RingShape>(file, FrozenKind::rings, number);
    columns.sources = column_of<SourceShape>(file, FrozenKind::sources, number);
    columns.warnings = std::move(warnings);
    check_bools(file, columns.spheres.values(), offsetof(SphereShape, inward));
    check_bools(file, columns.cones.values(), offsetof(ConeShape, inward));
    check_shapes(file, columns);
    return {std::move(columns), list};
}

/// Errors of the model's own checks, with the file's name.
template <class Map>
auto named(const FrozenFile& file, const Map& map) {
    try {
        return map();
    } catch (const InputError& error) {
        const std::string said = error.what();
        throw InputError(said.starts_with(file.name()) ? said : file.name() + ": " + said);
    }
}

/// Checks that a table of vertices is complete, or empty if no triangle needs it.
bool is_sound(const MeshModel& mesh, std::size_t table, bool needed) {
    return table == mesh.positions.size() || (table == 0 && !needed);
}

bool is_sound(const MeshModel& mesh) {
    const auto materials = static_cast<std::int64_t>(mesh.materials.modifiers.size());
    bool normals = false, uvs = false;
    for (const MeshModel::Triangle& triangle : mesh.triangles) {
        const bool corners = std::ranges::all_of(
            triangle.v, [&](std::uint32_t v) { return v < mesh.positions.size(); });
        if (!corners || triangle.material < kVoidIndex || triangle.material >= materials)
            return false;
        normals = normals || triangle.has_normals;
        uvs = uvs || triangle.has_uvs;
    }
    const auto finite = [](const MeshModel::Vertex& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    return is_sound(mesh, mesh.normals.size(), normals) && is_sound(mesh, mesh.us.size(), uvs) &&
           is_sound(mesh, mesh.vs.size(), uvs) && std::ranges::all_of(mesh.positions, finite) &&
           std::ranges::all_of(mesh.normals, finite);
}

}  // namespace

void freeze_model(const Model& model, const SurfaceShapes& shapes, std::uint32_t number,
                  FrozenParts& parts) {
    const SurfaceList::Columns& surfaces = model.surfaces.columns();
    PackedWriter writer;
    pack_modifiers(writer, model.modifiers);
    writer.texts(model.header);
    pack_cube(writer, model.cube);
    pack_skies(writer, model.skies);
    writer.count(surfaces.files.size());
    for (const FileName& name : surfaces.files) writer.text(name.text());
    writer.texts(shapes.columns().warnings);
    parts.add(FrozenKind::model, number, writer.bytes());
    parts.add(FrozenKind::records, number, surfaces.records.values());
    parts.add(FrozenKind::reals, number, surfaces.reals.values());
    parts.add(FrozenKind::corners, number, surfaces.corners.values());
    parts.add(FrozenKind::text, number, surfaces.text.values());
    parts.add(FrozenKind::strings, number, surfaces.strings.values());
    parts.add(FrozenKind::rows, number, shapes.columns().rows.values());
    parts.add(FrozenKind::spheres, number, shapes.columns().spheres.values());
    parts.add(FrozenKind::cones, number, shapes.columns().cones.values());
    parts.add(FrozenKind::rings, number, shapes.columns().rings.values());
    parts.add(FrozenKind::sources, number, shapes.columns().sources.values());
}

std::shared_ptr<const Model> map_model(const FrozenFile& file, std::uint32_t number) {
    return named(file, [&] {
        const auto mapped = std::make_shared<Mapped<Model>>();
        mapped->bytes = file.owner();
        Model& model = mapped->thing;
        PackedReader reader(part_of(file, FrozenKind::model, number), file.name(), "a model");
        model.modifiers = unpack_modifiers(reader);
        model.header = reader.texts();
        model.cube = unpack_cube(reader);
        model.skies = unpack_skies(reader);
        std::vector<FileName> files = unpack_files(reader);
        std::vector<std::string> warnings = reader.texts();
        reader.end();
        model.surfaces = map_surfaces(file, number, std::move(files), model.modifiers.size());
        if (!std::ranges::all_of(model.skies,
                                 [&](const GeneratedPart& sky) { return is_sound(sky, model); }))
            reader.fail();
        model.shapes = std::make_shared<const SurfaceShapes>(
            map_shapes(file, number, model.surfaces, std::move(warnings)));
        return std::shared_ptr<const Model>(mapped, &model);
    });
}

void freeze_mesh(const MeshModel& mesh, std::uint32_t number, FrozenParts& parts) {
    PackedWriter writer;
    pack_modifiers(writer, mesh.materials.modifiers);
    parts.add(FrozenKind::mesh, number, writer.bytes());
    parts.add(FrozenKind::positions, number, mesh.positions.values());
    parts.add(FrozenKind::normals, number, mesh.normals.values());
    parts.add(FrozenKind::us, number, mesh.us.values());
    parts.add(FrozenKind::vs, number, mesh.vs.values());
    parts.add(FrozenKind::triangles, number, mesh.triangles.values());
}

std::shared_ptr<const MeshModel> map_mesh(const FrozenFile& file, std::uint32_t number) {
    using Vertex = MeshModel::Vertex;
    using Triangle = MeshModel::Triangle;
    const auto mapped = std::make_shared<Mapped<MeshModel>>();
    mapped->bytes = file.owner();
    MeshModel& mesh = mapped->thing;
    PackedReader reader(part_of(file, FrozenKind::mesh, number), file.name(), "a mesh");
    mesh.materials.modifiers = unpack_modifiers(reader);
    reader.end();
    mesh.positions = column_of<Vertex>(file, FrozenKind::positions, number);
    mesh.normals = column_of<Vertex>(file, FrozenKind::normals, number);
    mesh.us = column_of<double>(file, FrozenKind::us, number);
    mesh.vs = column_of<double>(file, FrozenKind::vs, number);
    mesh.triangles = column_of<Triangle>(file, FrozenKind::triangles, number);
    check_bools(file, mesh.triangles.values(), offsetof(Triangle, has_normals));
    check_bools(file, mesh.triangles.values(), offsetof(Triangle, has_uvs));
    if (!is_sound(mesh)) reader.fail();
    return {mapped, &mesh};
}

}  // namespace lightwalk
