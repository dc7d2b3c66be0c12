#include "apps/walk/serve_command.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "apps/commands.h"
#include "apps/walk_command.h"

namespace lightwalk {
namespace {

/// Reads "WIDTHxHEIGHT"; false where it is none within the limits.
bool read_size(const std::string& word, WalkSizeLimit& size) {
    const std::size_t by = std::min(word.find('x'), word.size());
    const auto read = [&](std::size_t first, std::size_t last, int& side) {
        const auto [end, problem] = std::from_chars(word.data() + first, word.data() + last, side);
        return problem == std::errc{} && end == word.data() + last && side >= 1 &&
               side <= kLargestWalkSize;
    };
    return by < word.size() && read(0, by, size.width) && read(by + 1, word.size(), size.height);
}

CustomOption size_option(WalkSizeLimit& size) {
    const auto take = [&size](OptionWords& words) {
        const std::string word = words.text();
        if (!read_size(word, size))
            refuse_argument(
                "--max-size",
                "WIDTHxHEIGHT of at most " + std::to_string(kLargestWalkSize) + " pixels",
                '"' + word + '"');
    };
    return {take,
            [&size] { return std::to_string(size.width) + 'x' + std::to_string(size.height); }};
}

}  // namespace

std::vector<OptionRow> serve_option_rows(ServeCommand& serve, WalkCommand& walk) {
    return {{"The page, and who may open it", SectionTitle{}},
            {"--port N", &serve.port, "port of the page; 0: any that is free",
             With{.least = 0, .most = 65535}},
            {"--bind ADDRESS", &serve.address,
             "address that the page is served on. 127.0.0.1: to this machine alone. Anything else "
             "demands the token in the printed address"},
            {"--clients N", &serve.clients,
             "number of browsers at once: the first drives, others watch",
             With{.least = 1, .most = 256}},
            {"--fps N", &walk.rate,
             "frames a second while moving. A frame's time goes to its worst pixels; the others "
             "are interpolated now, and traced in a later frame",
             With{.least = .1, .most = 1000}},
            {"--max-size WxH", size_option(serve.max_size),
             "largest size of pictures; larger windows show them enlarged"},
            {"--ambient WHEN",
             choice(serve.ambient, {{"rest", AmbientUse::rest},
                                    {"always", AmbientUse::always},
                                    {"off", AmbientUse::off}}),
             "when there is indirect light, with -ab: rest: when the view rests; always; off. The "
             "page may change it"},
            {"--edge-samples N", &serve.edge_samples,
             "rays that a pixel at an edge gets when the view rests; 1: the picture of `lightwalk "
             "render`",
             With{.least = 1, .most = 255}}};
}

std::string view_title(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}

}  // namespace lightwalk
