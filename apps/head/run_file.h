#pragma once
// A file that a run makes for a page, over HTTP.
#include <string>

#include "apps/head/run_link.h"

namespace lightwalk {

/// Ask the run for `path`, which begins with "/save/", and answer with what it answers; within a
/// minute, else with a 503. Works on the context's thread.
void fetch_run_file(boost::asio::io_context& context, const RunPlace& place,
                    const std::string& path, WebReply reply);

}  // namespace lightwalk
