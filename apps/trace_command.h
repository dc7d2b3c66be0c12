#pragma once
// The options of `lightwalk trace`, read from a command line.
#include <memory>
#include <string>

#include "apps/common_options.h"
#include "io/rays/ray_reader.h"
#include "io/rays/ray_records.h"
#include "io/rays/ray_tree.h"

namespace lightwalk {

struct TraceCommand {
    CommonOptions common{"trace", OptionDefaults::rtrace};
    bool header = true;         ///< -h
    RayFormats formats;         ///< -f
    std::string letters = "v";  ///< -o
    TreeSelection tree;         ///< -te -ti -tE -tI
    ColorOutput color = ColorOutput::rgb;
    int x = 0, y = 0;    ///< -x -y
    int interval = 0;    ///< --interval: independent answers to each ray; 0: one, and no interval
    bool serve = false;  ///< --serve
    double idle = 600;   ///< --idle [s]
};

/// The options of trace, which set the command's members; must not outlive it.
/// @param files  where those are that options name
[[nodiscard]] OptionTable option_table(TraceCommand& command,
                                       const std::shared_ptr<FileSource>& files);

}  // namespace lightwalk
