#pragma once
// The page that browsers get, compiled into the program from apps/viewer.
#include <vector>

#include "io/net/web_server.h"

namespace lightwalk {

[[nodiscard]] const std::vector<WebAsset>& viewer_pages();

}  // namespace lightwalk
