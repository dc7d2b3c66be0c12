#pragma once
// The beam of a virtual source: the pyramid that its light fills beyond the mirror or prism.
#include <optional>

#include "core/geometry/shapes.h"
#include "core/light/light_source.h"

namespace lightwalk {

/// The beam of a virtual source through the outline of its redirecting surface. Nothing when the
/// source's box straddles the plane of that surface, or when the surface is not flat.
[[nodiscard]] std::optional<VirtualSourceBeam> virtual_source_beam(const LightSource& source,
                                                                   const Shape& surface);

}  // namespace lightwalk
