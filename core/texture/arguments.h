#pragma once
// Checks of argument counts that textures, patterns and mixtures share.
#include <cstddef>
#include <string>

#include "core/scene/modifier.h"

namespace lightwalk {

/// "TYPE \"NAME\": PROBLEM" at the primitive's place.
[[nodiscard]] InputError modifier_error(const Primitive& primitive, const std::string& problem);

/// Throws when the primitive has fewer arguments than these.
void require_arguments(const Primitive& primitive, std::size_t strings, std::size_t reals = 0);

}  // namespace lightwalk
