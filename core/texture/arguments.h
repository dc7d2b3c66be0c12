#pragma once
// Checks of argument counts that textures, patterns and mixtures share.
#include <cstddef>
#include <string>

#include "core/scene/modifier.h"

namespace lightwalk {

/// "TYPE \"NAME\": PROBLEM" at the primitive's place.
[[nodiscard]] InputError modifier_error(const Primitive& primitive, const std::string& problem);

/// Returns load(), which reads a file that the primitive names; adds the primitive's place to its
/// errors.
template <class Load>
auto load_for(const Primitive& primitive, const Load& load) {
    try {
        return load();
    } catch (const MissingFile& missing) {
        throw MissingFile(modifier_error(primitive, missing.what()).what());
    } catch (const InputError& error) {
        throw modifier_error(primitive, error.what());
    }
}

/// Throws when the primitive has fewer arguments than these.
void require_arguments(const Primitive& primitive, std::size_t strings, std::size_t reals = 0);

}  // namespace lightwalk
