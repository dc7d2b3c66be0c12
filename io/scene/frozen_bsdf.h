#pragma once
// BSDF data as parts of a frozen scene.
#include <memory>

#include "core/bsdf/bsdf_data.h"
#include "io/scene/frozen_parts.h"

namespace lightwalk {

void freeze_bsdf(const BsdfData& data, std::uint32_t number, FrozenParts& parts);
/// The inverse of freeze_bsdf. Throws InputError for contents that no decoder can have made.
[[nodiscard]] std::shared_ptr<const BsdfData> map_bsdf(const FrozenFile& file,
                                                       std::uint32_t number);

}  // namespace lightwalk
