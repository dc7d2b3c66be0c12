#pragma once
// The scene description as it was read: primitives with resolved names. See "The Radiance 6.x Scene
// Description Language" (Radiance's ray.pdf) for the primitive types and their arguments.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/model/column.h"
#include "core/model/primitive_type.h"
#include "core/model/surface_list.h"

namespace lightwalk {

inline constexpr std::int32_t kVoidIndex = -1;  ///< the modifier `void`
inline constexpr std::int32_t kUndefinedIndex =
    -2;  ///< a name in a string argument that nothing defines

/// One primitive. Modifiers are indices into Model::modifiers, always of earlier ones.
struct Primitive {
    PrimitiveType type{};
    std::int32_t modifier = kVoidIndex;
    std::string name;
    std::vector<std::string> strings;
    std::vector<double> reals;
    /// What names in string arguments resolve to, in their order: the alias target (never an alias
    /// itself); s0 of illum and mirror; s0 and s1 of the mixtures; s0, s4 and s8 of WGMDfunc;
    /// every string of antimatter. Empty for all other types.
    std::vector<std::int32_t> references;
    SourceLocation where;
};

/// Whether a modifier may be the one of a number: of a modifier's type, with finite numbers, and
/// names only of earlier ones. What bytes from elsewhere say of modifiers has to be so.
[[nodiscard]] bool is_sound_modifier(const Primitive& modifier, std::size_t number);

/// The cube an octree file was built with: it holds all its finite surfaces, and may be larger than
/// needed.
struct ModelCube {
    double x = 0, y = 0, z = 0;  ///< corner with the smallest coordinates
    double size = 0;             ///< edge [m]
    bool holds_all = true;       ///< false: surfaces were added since, which it may not hold
};

class SurfaceShapes;

/// Primitives that a command in a scene file has written.
struct GeneratedPart {
    SourceLocation where;
    std::string command;  ///< as it stands there
    std::string refusal;  ///< why it cannot be run for other primitives; "": it can
    std::int32_t first_modifier = 0, last_modifier = 0;  ///< into Model::modifiers; exclusive
    std::size_t first_surface = 0, last_surface = 0;     ///< into Model::surfaces; exclusive
};

/// One name space: a scene, or the contents of one octree. Modifiers and surfaces are numbered
/// apart, each in the order of their definitions.
struct Model {
    std::vector<Primitive> modifiers;
    SurfaceList surfaces;
    std::vector<std::string> header;   ///< information header lines of an octree, without FORMAT
    std::vector<GeneratedPart> skies;  ///< that gensky and gendaylit have written into scene files
    std::optional<ModelCube> cube;     ///< as read from an octree; nothing for scene files
    /// The result of make_shapes for `surfaces`, where it was read from a file; else null.
    std::shared_ptr<const SurfaceShapes> shapes;

    /// The number of primitives of all kinds.
    [[nodiscard]] std::size_t size() const { return modifiers.size() + surfaces.size(); }
};

/// A compiled triangle mesh (.rtm): its materials and triangles.
struct MeshModel {
    struct Vertex {
        double x = 0, y = 0, z = 0;
    };
    struct Triangle {
        std::uint32_t v[3] =
            {};  ///< into `positions` (and `normals`, `uvs` where those are not empty)
        std::int32_t material = kVoidIndex;  ///< into materials.modifiers
        bool has_normals = false, has_uvs = false;
        std::uint16_t unused = 0;  ///< explicit padding: files of triangles are reproducible
    };
    Model materials;
    Column<Vertex> positions;
    Column<Vertex> normals;  ///< unit, per vertex, or empty
    Column<double> us, vs;   ///< texture coordinates per vertex, or empty
    Column<Triangle> triangles;

    /// Bytes in the process's own memory, without the materials.
    [[nodiscard]] std::size_t own_bytes() const {
        return positions.own_bytes() + normals.own_bytes() + us.own_bytes() + vs.own_bytes() +
               triangles.own_bytes();
    }
};

}  // namespace lightwalk
