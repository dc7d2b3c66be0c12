#pragma once
// What the hash of the surfaces on a point's way says of their materials.
#include <cstdint>

#include "core/cloud/point.h"
#include "core/math/random.h"
#include "core/model/ids.h"

namespace lightwalk {

/// The kMaterialBits of a way that goes on to a surface with a modifier. They depend on the
/// sequence of modifiers alone.
/// @param met  the bits of the way before; 0: it begins
[[nodiscard]] inline std::uint32_t met_material(std::uint32_t met, ModifierId modifier) {
    return static_cast<std::uint32_t>(
               mix_bits((met & kMaterialBits) + (std::uint64_t{1} << 32) +
                        (std::uint64_t{static_cast<std::uint32_t>(index(modifier))} << 8))) &
           kMaterialBits;
}

}  // namespace lightwalk
