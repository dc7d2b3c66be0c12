#pragma once
// The scene description as it was read: primitives with resolved names. See "The Radiance 6.x Scene
// Description Language" (Radiance's ray.pdf) for the primitive types and their arguments.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace lightwalk {

enum class PrimitiveType : std::uint8_t {
#define PRIMITIVE(id, word, kind) id,
#include "core/model/primitive_types.def"
};

/// What a primitive type is for.
enum class PrimitiveKind : std::uint8_t {
    surface,
    light,     ///< a material that emits
    material,  ///< any other
    texture,
    pattern,
    mixture,
    spectrum,
    alias,
};

/// The scene file's word for a type ("BRTDfunc"), and back; nothing for an unknown word.
[[nodiscard]] std::string_view to_string(PrimitiveType type);
[[nodiscard]] std::optional<PrimitiveType> primitive_type(std::string_view word);
[[nodiscard]] PrimitiveKind kind_of(PrimitiveType type);
[[nodiscard]] inline bool is_surface(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::surface;
}
/// Materials that emit.
[[nodiscard]] inline bool is_light(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::light;
}
/// Materials of all kinds, lights among them.
[[nodiscard]] inline bool is_material(PrimitiveType type) {
    return is_light(type) || kind_of(type) == PrimitiveKind::material;
}
[[nodiscard]] inline bool is_mixture(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::mixture;
}

inline constexpr std::int32_t kVoidIndex = -1;  ///< the modifier `void`
inline constexpr std::int32_t kUndefinedIndex =
    -2;  ///< a name in a string argument that nothing defines

/// One primitive. Modifiers are indices into the vector that holds the primitive, always of earlier
/// ones.
struct Primitive {
    PrimitiveType type{};
    std::int32_t modifier = kVoidIndex;
    std::string name;
    std::vector<std::string> strings;
    std::vector<double> reals;
    /// What names in string arguments resolve to, index by index: the alias target (never an alias
    /// itself); s0 of illum and mirror; s0 and s1 of the mixtures; every string of antimatter.
    /// Empty for all other types.
    std::vector<std::int32_t> references;
    SourceLocation where;
};

/// The cube an octree file was built with: it holds all its finite surfaces, and may be larger than
/// needed.
struct ModelCube {
    double x = 0, y = 0, z = 0;  ///< corner with the smallest coordinates
    double size = 0;             ///< edge [m]
};

/// One name space: a scene, or the contents of one octree.
struct Model {
    std::vector<Primitive> primitives;
    std::vector<std::string> header;  ///< information header lines of an octree, without FORMAT
    std::optional<ModelCube> cube;    ///< as an octree states it; nothing for scene files
};

/// A compiled triangle mesh (.rtm): its materials and triangles.
struct MeshModel {
    struct Vertex {
        double x = 0, y = 0, z = 0;
    };
    struct Triangle {
        std::uint32_t v[3] =
            {};  ///< into `positions` (and `normals`, `uvs` where those are not empty)
        std::int32_t material = kVoidIndex;  ///< into materials.primitives
        bool has_normals = false, has_uvs = false;
    };
    Model materials;
    std::vector<Vertex> positions;
    std::vector<Vertex> normals;  ///< unit, per vertex, or empty
    std::vector<double> us, vs;   ///< texture coordinates per vertex, or empty
    std::vector<Triangle> triangles;
};

}  // namespace lightwalk
