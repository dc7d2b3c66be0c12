#include "apps/walk/serve_command.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "apps/walk_command.h"

namespace lightwalk {
namespace {

WalkSizeLimit size_limit(const std::string& word) {
    WalkSizeLimit size;
    const std::size_t by = std::min(word.find('x'), word.size());
    const auto read = [&](std::size_t first, std::size_t last, int& side) {
        const auto [end, problem] = std::from_chars(word.data() + first, word.data() + last, side);
        return problem == std::errc{} && end == word.data() + last && side >= 1 &&
               side <= kLargestWalkSize;
    };
    if (by == word.size() || !read(0, by, size.width) || !read(by + 1, word.size(), size.height))
        throw UsageError("option --max-size: expected WIDTHxHEIGHT of at most " +
                         std::to_string(kLargestWalkSize) + " pixels, found \"" + word + "\"");
    return size;
}

AmbientUse ambient_use(const std::string& word) {
    if (word == "rest") return AmbientUse::rest;
    if (word == "always") return AmbientUse::always;
    if (word == "off") return AmbientUse::off;
    throw UsageError("option --ambient: expected rest, always or off, found \"" + word + "\"");
}

}  // namespace

bool parse_serve_option(OptionWords& words, ServeCommand& serve) {
    const std::string word = words.option();
    constexpr int kLastPort = 65535, kMostClients = 256, kMostSamples = 255;
    if (word == "--bind")
        serve.address = words.text();
    else if (word == "--port")
        serve.port = whole_number(words, 0, kLastPort);
    else if (word == "--clients")
        serve.clients = whole_number(words, 1, kMostClients);
    else if (word == "--max-size")
        serve.max_size = size_limit(words.text());
    else if (word == "--ambient")
        serve.ambient = ambient_use(words.text());
    else if (word == "--edge-samples")
        serve.edge_samples = whole_number(words, 1, kMostSamples);
    else
        return false;
    return true;
}

std::vector<std::string> serve_option_names() {
    return {"--bind", "--port", "--clients", "--max-size", "--ambient", "--edge-samples"};
}

std::string view_title(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}

}  // namespace lightwalk
