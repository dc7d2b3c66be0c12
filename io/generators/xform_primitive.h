#pragma once
// What a transform does to one primitive of the scene language.
#include <string>
#include <vector>

#include "core/math/transform.h"
#include "io/language/primitive_text.h"

namespace lightwalk {

/// One application of xform: everything but the primitives.
struct XformStep {
    Transform transform;
    std::vector<std::string>
        words;            ///< the transform's options, for primitives that keep them as strings
    bool invert = false;  ///< turn every surface inside out
    std::string prefix;   ///< of surface identifiers, without the '.'; "" for none
    std::string surface_modifier;  ///< replaces the modifier of every surface; "" for none
};

/// Append `primitive`, transformed, to `out`. Throws InputError "bad TYPE "NAME"" for argument
/// counts that leave nothing to transform. Source: Radiance manual page xform(1).
void write_transformed(const PrimitiveText& primitive, const XformStep& step, std::string& out);

}  // namespace lightwalk
