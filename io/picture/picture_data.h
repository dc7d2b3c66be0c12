#pragma once
// Decodes pictures to tables, for patterns that look up their values.
#include <string>
#include <string_view>

#include "core/model/resources.h"

namespace lightwalk {

/// The axes of a picture, without values.
/// @param aspect  a pixel's height / width
[[nodiscard]] PictureData empty_picture(int columns, int rows, double aspect);

/// Decode an RGBE picture (any orientation; flat, old or new run-length form) to a table whose
/// shorter side has length 1. PIXASPECT is respected, EXPOSURE and COLORCORR are ignored. Throws
/// InputError "name: ..." for other formats and damaged files, and allocates no more than the size
/// of the file justifies.
[[nodiscard]] PictureData decode_picture(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
