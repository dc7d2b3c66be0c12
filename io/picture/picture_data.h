#pragma once
// Pictures as tables, for patterns that look them up.
#include <string>
#include <string_view>

#include "core/model/resources.h"

namespace lightwalk {

/// RGBE picture (any orientation, flat, old or new run-length form) as a table whose shorter side
/// has length 1; PIXASPECT is heeded, EXPOSURE and COLORCORR are not; other formats are refused.
/// Throws InputError "name: ..." for damaged files, and bounds what it allocates by what they hold.
[[nodiscard]] PictureData decode_picture(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
