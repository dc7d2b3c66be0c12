#pragma once
// The pyramid that a relayed source's light fills behind its mirror or prism.
#include <optional>

#include "core/geometry/shapes.h"
#include "core/light/light_source.h"

namespace lightwalk {

/// The beam of a virtual source through the outline of its relay. Nothing when the source's box
/// straddles the relay's plane, or the relay is not flat.
[[nodiscard]] std::optional<RelayBeam> relay_beam(const LightSource& source, const Shape& relay);

}  // namespace lightwalk
