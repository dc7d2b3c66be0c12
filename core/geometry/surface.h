#pragma once
// Surfaces as the intersector sees them.
#include <cstdint>
#include <string>
#include <variant>

#include "core/geometry/shapes.h"
#include "core/model/ids.h"
#include "core/model/primitive.h"

namespace lightwalk {

/// What an opaque-or-not shadow query has to know of a surface's modifier chain.
enum class ShadowClass : std::uint8_t {
    ignored,  ///< no material: the ray passes as if nothing were there
    blocks,   ///< the first such surface before the light ends the matter, whatever else lies in
              ///< between
    special,  ///< glass, trans, mixtures, illum, ...: has to be shaded to know
};

/// Tie rules of coincident surfaces and shadow queries, derived from the modifier chain.
struct SurfaceTraits {
    bool has_material = false;
    bool transparent = false;  ///< nominally transparent material (Radiance's isopaque rule)
    ShadowClass shadow = ShadowClass::ignored;
};

/// One surface primitive. `name` is what tracers report.
struct Surface {
    PrimitiveType type{};
    ModifierId modifier = kVoid;
    SurfaceTraits traits;
    Shape shape;  ///< monostate for instances, meshes and degenerate (ignored) surfaces
    std::string name;
    SourceLocation where;

    /// Polygon or ring: what the reference calls a flat object.
    [[nodiscard]] bool is_flat() const {
        return type == PrimitiveType::polygon || type == PrimitiveType::ring;
    }
};

}  // namespace lightwalk
