#include "io/scene/octree_writer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string_view>
#include <unordered_map>

#include "core/geometry/bounds.h"
#include "core/geometry/shapes.h"
#include "core/math/portable_numbers.h"
#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

constexpr std::uint64_t kMagic = 283 + kObjectNumberSize;
constexpr std::size_t kMostArguments = 65535;
constexpr double kMargin = 1e-5;  ///< of a cube around surfaces, on each side [m]

Bounds box_of(const ModelCube& cube) {
    const Vec3 lower{cube.x, cube.y, cube.z};
    return {lower, lower + Vec3{cube.size, cube.size, cube.size}};
}

bool holds(const ModelCube& cube, const Bounds& bounds) {
    const Bounds box = box_of(cube);
    return bounds.empty() || (contains(box, bounds.lower) && contains(box, bounds.upper));
}

Bounds bounds_of_mesh(const MeshModel& mesh) {
    Bounds bounds;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const MeshModel::Vertex& p = mesh.positions[i];
        bounds.extend({p.x, p.y, p.z});
    }
    return bounds;
}

/// Boxes of what is placed, each found out once.
class PlacedBounds {
  public:
    explicit PlacedBounds(Resources& resources) : resources_(resources) {}

    Bounds of(const SurfacePrimitive& surface) {
        const std::vector<std::string> words = surface.strings.to_strings();
        if (words.empty()) throw InputError(surface.where(), "names no file to place");
        const std::span<const std::string> rest = std::span(words).subspan(1);
        const ParsedTransform parsed = parse_transform(rest);
        if (parsed.words != rest.size()) throw InputError(surface.where(), "bad transform");
        const Bounds own = surface.type == PrimitiveType::mesh ? mesh(words[0]) : octree(words[0]);
        return own.empty() ? own : transformed(own, parsed.transform.forward);
    }

  private:
    Bounds mesh(const std::string& name) {
        const auto [entry, is_new] = meshes_.try_emplace(name);
        if (is_new) entry->second = bounds_of_mesh(*resources_.mesh(name));
        return entry->second;
    }
    Bounds octree(const std::string& name) {
        const auto [entry, is_new] = octrees_.try_emplace(name);
        if (is_new)
            if (const auto& cube = resources_.octree(name)->cube) entry->second = box_of(*cube);
        return entry->second;
    }

    Resources& resources_;
    std::unordered_map<std::string, Bounds> meshes_, octrees_;
};

struct TreeContents {
    std::vector<TreeObject> objects;  ///< the finite surfaces that have a shape
    Bounds bounds;                    ///< of the surfaces themselves, which cubes are made around
};

TreeContents tree_contents(const Model& model, Resources& resources, WarningSink& warnings) {
    PlacedBounds placed(resources);
    TreeContents tree;
    tree.objects.reserve(model.surfaces.size());
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
        const SurfacePrimitive surface = model.surfaces[i];
        TreeObject object;
        object.number = static_cast<std::uint32_t>(model.modifiers.size() + i);
        if (is_placement(surface.type)) {
            object.bounds = placed.of(surface);
            extend(tree.bounds, object.bounds);
        } else {
            const ValidatedShape made = make_shape(surface);
            if (!made.warning.empty()) warnings.warn(to_prefix(surface.where()) + made.warning);
            object.bounds = hit_bounds(made.shape);
            extend(tree.bounds, bounds_of(made.shape));
            const auto* const polygon = std::get_if<PolygonShape>(&made.shape);
            if (polygon != nullptr && polygon->vertices.size() == 3) {
                object.normal = polygon->normal;
                object.offset = polygon->offset;
            }
        }
        if (!object.bounds.empty()) tree.objects.push_back(object);
    }
    return tree;
}

ModelCube smallest_cube(const Bounds& bounds) {
    if (bounds.empty()) return {};
    const Vec3 size = bounds.upper - bounds.lower;
    const double edge = std::max({size.x, size.y, size.z}) + 2 * kMargin;
    const Vec3 corner = (bounds.lower + bounds.upper) * 0.5 - Vec3{edge, edge, edge} * 0.5;
    return {corner.x, corner.y, corner.z, edge};
}

ModelCube cube_of(const OctreeOptions& options, const Bounds& bounds) {
    if (!options.cube) return smallest_cube(bounds);
    if (holds(*options.cube, bounds)) return *options.cube;
    if (options.strict) throw InputError("boundary does not encompass scene");
    Bounds all = bounds;
    if (options.cube->size > 0) extend(all, box_of(*options.cube));
    return smallest_cube(all);
}

class ObjectWriter {
  public:
    explicit ObjectWriter(std::string& bytes) : bytes_(bytes) {}

    void string(std::string_view text) {
        bytes_ += text;
        bytes_ += '\0';
    }
    void types() {
        for (std::size_t i = 0; i < primitive_type_count(); ++i)
            string(to_string(static_cast<PrimitiveType>(i)));
        string("");
    }
    template <class Strings, class Reals>
    void object(PrimitiveType type, std::int32_t modifier, std::string_view name,
                const Strings& strings, const Reals& reals, const SourceLocation& where) {
        if (strings.size() > kMostArguments || reals.size() > kMostArguments)
            throw InputError(where, "an octree cannot hold a primitive of " +
                                        std::to_string(std::max(strings.size(), reals.size())) +
                                        " arguments, at most " + std::to_string(kMostArguments));
        append_integer(bytes_, static_cast<std::uint64_t>(type), 1);
        append_integer(bytes_, static_cast<std::uint64_t>(static_cast<std::int64_t>(modifier)),
                       kObjectNumberSize);
        string(name);
        append_integer(bytes_, strings.size(), 2);
        for (std::size_t i = 0; i < strings.size(); ++i) string(strings[i]);
        append_integer(bytes_, reals.size(), 2);
        for (std::size_t i = 0; i < reals.size(); ++i) append_real(bytes_, reals[i]);
    }
    void end() { append_integer(bytes_, ~std::uint64_t{0}, 1); }

  private:
    std::string& bytes_;
};

/// An alias names its target by a word, which may mean another modifier by now: then it is written
/// as what it stands for.
void write_modifiers(const Model& model, ObjectWriter& writer) {
    std::unordered_map<std::string_view, std::int32_t> latest;
    for (std::size_t i = 0; i < model.modifiers.size(); ++i) {
        const Primitive& own = model.modifiers[i];
        const Primitive* said = &own;
        if (own.type == PrimitiveType::alias && !own.references.empty()) {
            const auto found = latest.find(own.strings[0]);
            if (found == latest.end() || found->second != own.references[0])
                said = &model.modifiers[static_cast<std::size_t>(own.references[0])];
        }
        writer.object(said->type, own.modifier, own.name, said->strings, said->reals, own.where);
        latest[own.name] = static_cast<std::int32_t>(i);
    }
}

void append_text(std::string& bytes, const char* format, double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, value);
    bytes += text.data();
    bytes += '\0';
}

}  // namespace

std::string encode_octree(const Model& model, Resources& resources, const OctreeOptions& options,
                          WarningSink& warnings) {
    const TreeContents tree = tree_contents(model, resources, warnings);
    const ModelCube cube = cube_of(options, tree.bounds);
    std::string bytes = "#?RADIANCE\n";
    for (const std::string& line : options.header) bytes += line + '\n';
    bytes += "FORMAT=Radiance_octree\n\n";
    append_integer(bytes, kMagic, 2);
    for (const double number : {cube.x, cube.y, cube.z, cube.size})
        append_text(bytes, "%.12g", number);
    bytes += '\0';  // no scene files
    append_integer(bytes, model.size(), kObjectNumberSize);
    bytes += encode_tree(tree.objects, cube, options.limits);
    ObjectWriter writer(bytes);
    writer.types();
    write_modifiers(model, writer);
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
        const SurfacePrimitive surface = model.surfaces[i];
        writer.object(surface.type, surface.modifier, surface.name, surface.strings, surface.reals,
                      surface.where());
    }
    writer.end();
    return bytes;
}

}  // namespace lightwalk
