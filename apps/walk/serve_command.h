#pragma once
// What `lightwalk walk` knows beside the options of `lightwalk animate`.
#include <string>
#include <vector>

#include "io/net/walk_reply.h"
#include "io/options/option_words.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

struct ServeCommand {
    std::string address = "127.0.0.1";      ///< --bind
    int port = 8080;                        ///< --port; 0: any that is free
    int clients = 8;                        ///< --clients
    WalkSizeLimit max_size{1920, 1200};     ///< --max-size
    AmbientUse ambient = AmbientUse::rest;  ///< --ambient
    int edge_samples = 8;          ///< --edge-samples: rays a pixel at an edge gets at rest
    std::vector<NamedView> views;  ///< -vf
};

/// Take an option of walk's own; false when the word is another one. Throws UsageError.
[[nodiscard]] bool parse_serve_option(OptionWords& words, ServeCommand& serve);

/// Names of these options, for suggestions.
[[nodiscard]] std::vector<std::string> serve_option_names();

/// What a view file is called in the page: its name without folders and ending.
[[nodiscard]] std::string view_title(const std::string& path);

}  // namespace lightwalk
