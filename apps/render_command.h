#pragma once
// The options of `lightwalk render`, `animate` and `walk`, read from a command line.
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/session/picture_series.h"
#include "apps/walk_command.h"
#include "core/view/view.h"

namespace lightwalk {

struct RenderCommand {
    /// With the defaults of a command: render, animate or walk.
    explicit RenderCommand(const std::string& name);

    CommonOptions common;
    View view;
    bool view_given = false;            ///< an option named a part of the view
    int x = 512, y = 512;               ///< -x -y: largest size [pixels]
    double pixel_aspect = 1;            ///< -pa: height / width; 0: exactly -x by -y
    bool spacing_given = false;         ///< -ps was named
    SeriesOutput output;                ///< -o -z -pc -pXYZ --exposure --tone
    std::optional<int> sample_lights;   ///< --sample-lights; nothing: auto
    std::string checkpoint;             ///< --checkpoint; "" is none
    bool resume = false;                ///< --resume
    double report_interval = 0;         ///< -t [s]
    std::string rad_view;               ///< -v: of a rad file; "": its first
    int first_frame = 0;                ///< -S: number of the first of a sequence; 0: one picture
    std::optional<WalkCommand> walk;    ///< of `animate` and `walk`; nothing for `render`
    std::optional<ServeCommand> serve;  ///< of `walk`
};

/// The options of the command, which set its members; must not outlive it.
/// @param files  where those are that options name
[[nodiscard]] OptionTable option_table(RenderCommand& command,
                                       const std::shared_ptr<FileSource>& files);

/// What can only be told when all options are known; reads the file of --path. Throws UsageError,
/// and InputError for that file.
void check_render_command(RenderCommand& command, FileSource& files);

/// Whether its frames reuse each other's points.
[[nodiscard]] inline bool reuses_frames(const RenderCommand& command) {
    return command.walk && command.walk->reuse;
}
/// Sets what follows from other options: the spacing of pixels, light samples, reuse.
void settle_render_command(RenderCommand& command, WarningSink& warnings);
/// The size of a view's picture. Throws InputError for a bad view, UsageError for too many pixels.
[[nodiscard]] PictureSize picture_size(const RenderCommand& command, const View& view,
                                       WarningSink& warnings);

}  // namespace lightwalk
