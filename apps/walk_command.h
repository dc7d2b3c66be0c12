#pragma once
// The options of `lightwalk animate` and `walk` that `lightwalk render` does not have: the path of
// the camera, the reuse of earlier frames, and the page.
#include <string>
#include <vector>

#include "apps/session/lightwalk/renderer.h"
#include "core/view/view_path.h"
#include "io/net/walk_reply.h"
#include "io/net/web_server.h"
#include "io/options/option_rows.h"
#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

class Scene;

struct WalkCommand {
    /// How the views of the frames come about.
    enum class Way { none, path, rotate, walk };
    Way way = Way::none;
    std::string path;                       ///< --path
    std::vector<ViewKey> keys;              ///< what that file holds
    double degrees = 0;                     ///< --rotate: of the whole turn, to the right
    WalkMove move = WalkMove::forward;      ///< --walk
    double step = 0.01;                     ///< --step: share of the field of view
    int frames = 0;                         ///< --frames; 0: one for each view of the path
    double rate = 25;                       ///< --fps: of a film's frames [1/s]
    bool reuse = true;                      ///< --reuse off: every frame is traced
    CloudOptions cloud = *default_reuse();  ///< the other values of --reuse, and what goes with it
};

/// What `lightwalk walk` serves.
struct ServeCommand {
    WebServerOptions server;  ///< --bind --port --clients
    WelcomeReply page;        ///< --fps --max-size --ambient -vf: what browsers are told
    int edge_samples = 8;     ///< --edge-samples: rays a pixel at an edge gets at rest
    std::string beside;       ///< --beside: files of the scene to be compared; "": the walk's own
    bool watch = true;        ///< --watch: files that are edited are read again
    bool denoise = false;     ///< --denoise: pictures at rest may be, for the eye
};

/// The rows of animate's own options, which walk takes as well but for those on the path.
/// @param projectors  see RankOptions
[[nodiscard]] std::vector<OptionRow> walk_option_rows(WalkCommand& walk, int& projectors);
/// The rows of walk's own options.
[[nodiscard]] std::vector<OptionRow> serve_option_rows(ServeCommand& serve);

/// What can only be told when all options are known; reads the path file.
/// @param view  of the command line: what the path's first line starts from
/// Throws UsageError, and InputError for a path file that cannot be read or is none.
void resolve_walk(WalkCommand& walk, const View& view, FileSource& files);

/// Number of its frames.
[[nodiscard]] std::size_t walk_length(const WalkCommand& walk);

/// The views of all frames, from the first one.
/// @param view  of the command line: where moves begin
[[nodiscard]] std::vector<View> walk_views(const WalkCommand& walk, const View& view,
                                           const Scene& scene);

}  // namespace lightwalk
