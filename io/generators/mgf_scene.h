#pragma once
// Translates the Materials and Geometry Format to the scene language. Source: Ward, "The Materials
// and Geometry Format, version 2.0", LBNL (1996).
#include <string>
#include <string_view>

#include "core/error.h"
#include "io/generators/generator.h"

namespace lightwalk {

/// Geometry of the format as scene text.
/// @param where  of its first line, for messages
/// @param unit   length of its unit
/// Faces with holes and with normals, spheres, cylinders, cones, rings, prisms and tori are
/// translated; transformations go through xform. Entities that are not known, and ies, are warned
/// of and left out. Throws InputError `file:line: ...` for what is wrong, and for files that it
/// wants to include.
[[nodiscard]] std::string mgf_to_scene(std::string_view text, const SourceLocation& where,
                                       double unit, GeneratorContext& context);

}  // namespace lightwalk
