#pragma once
// The options of `lightwalk trace`, read from a command line.
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "io/rays/ray_reader.h"
#include "io/rays/ray_records.h"
#include "io/rays/ray_tree.h"

namespace lightwalk {

struct TraceCommand {
    CommonOptions common;
    RenderSettings settings = default_render_settings(OptionDefaults::rtrace);
    bool header = true;         ///< -h
    RayFormats formats;         ///< -f
    std::string letters = "v";  ///< -o
    TreeSelection tree;         ///< -te -ti -tE -tI
    ColorOutput color = ColorOutput::rgb;
    bool sensor = false;           ///< -I
    bool limit_by_length = false;  ///< -ld
    int x = 0, y = 0;              ///< -x -y
    bool show_defaults = false;    ///< -defaults
    std::string history;           ///< the command line for the output's header
};

/// Throws UsageError, and InputError for files that options name.
[[nodiscard]] TraceCommand parse_trace_command(const std::vector<std::string>& words,
                                               const std::shared_ptr<FileSource>& files);

/// What -defaults prints: every option with its value.
[[nodiscard]] std::string describe(const TraceCommand& command);

/// The options of trace, with their defaults.
[[nodiscard]] OptionTable trace_option_table();

}  // namespace lightwalk
