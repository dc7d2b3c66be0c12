#include "apps/walk/serve_command.h"

#include <cstdio>
#include <filesystem>

#include "apps/walk_command.h"

namespace lightwalk {
namespace {

WalkSizeLimit size_limit(const std::string& word) {
    WalkSizeLimit size;
    int used = 0;
    if (std::sscanf(word.c_str(), "%dx%d%n", &size.width, &size.height, &used) != 2 ||
        static_cast<std::size_t>(used) != word.size() || size.width < 1 || size.height < 1 ||
        size.width > kLargestWalkSize || size.height > kLargestWalkSize)
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
