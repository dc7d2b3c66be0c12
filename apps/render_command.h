#pragma once
// The options of `lightwalk render`, `animate` and `walk`, read from a command line.
#include <array>
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/walk/serve_command.h"
#include "apps/walk_command.h"
#include "core/view/view.h"
#include "io/picture/tone.h"
#include "parallel/pixel_rays.h"

namespace lightwalk {

struct RenderCommand {
    std::string name = "render";  ///< of the command
    CommonOptions common;
    RenderSettings settings;
    View view;
    int x = 512, y = 512;                            ///< -x -y: largest size [pixels]
    double pixel_aspect = 1;                         ///< -pa: height / width; 0: exactly -x by -y
    PixelOptions pixels;                             ///< -ps -pt -pj -pd -pm --samples
    bool spacing_given = false;                      ///< -ps was named
    std::optional<std::array<double, 8>> primaries;  ///< -pc: what the header says of the channels
    bool xyz = false;                                ///< -pXYZ: the picture holds CIE XYZ, not RGB
    std::string output;                              ///< -o; "" is standard output
    std::string depth;                               ///< -z; "" is none
    std::string checkpoint;                          ///< --checkpoint; "" is none
    bool resume = false;                             ///< --resume
    double report_interval = 0;                      ///< -t [s]
    ToneMapping tone;                                ///< --exposure --tone
    bool prepass = true;                             ///< --overture auto|off
    bool deterministic = false;                      ///< --deterministic
    int first_frame = 0;  ///< -S: number of the first frame of a sequence; 0: one picture
    std::optional<WalkCommand> walk;    ///< of `lightwalk animate`; nothing for `render`
    std::optional<ServeCommand> serve;  ///< of `lightwalk walk`, beside `walk`
    bool view_given = false;            ///< an option named a part of the view
    bool show_defaults = false;         ///< -defaults
    std::string history;                ///< the command line for the picture's header
};

/// Throws UsageError, and InputError for files that options name.
/// @param name  of the command: render, animate or walk
[[nodiscard]] RenderCommand parse_render_command(const std::string& name,
                                                 const std::vector<std::string>& words,
                                                 const std::shared_ptr<FileSource>& files);

/// What -defaults prints: every option with its value.
[[nodiscard]] std::string describe(const RenderCommand& command);

/// The options of render, animate or walk, with their defaults.
[[nodiscard]] OptionTable render_option_table(const std::string& name);

}  // namespace lightwalk
