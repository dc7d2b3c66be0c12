#pragma once
// What a renderer is opened for, by this process or by ranks.
#include <functional>
#include <memory>
#include <string>

#include "apps/rank_options.h"
#include "apps/session/lightwalk/renderer.h"
#include "io/files/file_source.h"

namespace lightwalk {

struct RendererRequest {
    SceneSource source;
    RendererOptions options;
    SceneFrom scene_from = SceneFrom::shared;
    int projectors = 0;   ///< ranks that keep points of a walk, at most
    std::string history;  ///< the command line, which must be the same on all ranks
    std::shared_ptr<FileSource> files = real_files();
    std::function<void()> when_read;  ///< called before what was read is compiled; none: nobody
};

}  // namespace lightwalk
