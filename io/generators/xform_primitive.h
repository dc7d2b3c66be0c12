#pragma once
// Applies a transformation of xform to a primitive of the scene language.
#include <string>
#include <vector>

#include "core/math/transform.h"
#include "io/language/primitive_text.h"

namespace lightwalk {

/// One transformation of xform, with its other effects on primitives.
struct XformStep {
    Transform transform;
    std::vector<std::string>
        words;            ///< options of the transform, for primitives that store them as strings
    bool invert = false;  ///< reverse the orientation of every surface
    std::string prefix;   ///< prefix of surface names, without the '.'; "" for none
    std::string surface_modifier;  ///< new modifier of every surface; "" to keep theirs
};

/// Append the transformed `primitive` to `out`. Throws InputError "bad TYPE "NAME"" when it has too
/// few arguments. Source: Radiance manual page xform(1).
void write_transformed(const PrimitiveText& primitive, const XformStep& step, std::string& out);

}  // namespace lightwalk
