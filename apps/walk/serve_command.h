#pragma once
// The options of `lightwalk walk` that `lightwalk animate` does not have.
#include <string>
#include <vector>

#include "io/net/walk_reply.h"
#include "io/options/option_rows.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

struct WalkCommand;

struct ServeCommand {
    std::string address = "127.0.0.1";      ///< --bind
    int port = 8080;                        ///< --port; 0: any that is free
    int clients = 8;                        ///< --clients
    WalkSizeLimit max_size{1920, 1200};     ///< --max-size
    AmbientUse ambient = AmbientUse::rest;  ///< --ambient
    int edge_samples = 8;          ///< --edge-samples: rays a pixel at an edge gets at rest
    std::vector<NamedView> views;  ///< -vf
};

/// The rows of walk's own options.
/// @param walk  whose rate --fps sets
[[nodiscard]] std::vector<OptionRow> serve_option_rows(ServeCommand& serve, WalkCommand& walk);

/// What a view file is called in the page: its name without folders and ending.
[[nodiscard]] std::string view_title(const std::string& path);

}  // namespace lightwalk
