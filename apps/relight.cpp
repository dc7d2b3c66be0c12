// lightwalk relight: light groups, dimmed and coloured, added up to a picture.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "apps/command_run.h"
#include "apps/commands.h"
#include "apps/common_options.h"
#include "core/model/transform_args.h"
#include "io/picture/layers.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {
namespace {

struct RelightCommand {
    CommonOptions common{"relight"};
    std::map<std::string, Rgb> levels;  ///< --group
    std::string output;                 ///< -o; "": standard output
    ToneMapping tone;                   ///< --exposure
};

/// LEVEL or LEVEL,R,G,B: the level times a colour; nothing for other texts.
std::optional<Rgb> parse_level(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream words(text + ',');
    for (std::string word; std::getline(words, word, ',');) {
        double number = 0;
        if (!parse_real(word, number) || !std::isfinite(number) || number < 0) return std::nullopt;
        numbers.push_back(number);
    }
    if (numbers.size() != 1 && numbers.size() != 4) return std::nullopt;
    Rgb level = Rgb::grey(1);
    for (std::size_t k = 0; k < 3; ++k)
        level[k] = static_cast<float>(numbers[0] * (numbers.size() == 4 ? numbers[k + 1] : 1));
    return level;
}

CustomOption level_option(RelightCommand& c) {
    return {[&c](OptionWords& words) {
        const std::string word = words.text();
        const std::size_t at = word.rfind('=');
        const std::optional<Rgb> level =
            at == std::string::npos ? std::nullopt : parse_level(word.substr(at + 1));
        if (!level || at == 0)
            refuse_argument("--group", "NAME=LEVEL or NAME=LEVEL,R,G,B, no number below 0",
                            '"' + word + '"');
        if (!c.levels.emplace(word.substr(0, at), *level).second)
            throw UsageError("option --group: two levels of \"" + word.substr(0, at) + '"');
    }};
}

OptionTable relight_table(RelightCommand& c) {
    const Action answered{[] {}};  // by main, wherever they stand
    const std::vector<OptionRow> own{
        {"Mixture", SectionTitle{}},
        {"--group NAME=LEVEL[,R,G,B]", level_option(c),
         "a group's level: 0 is off, 1 as it was rendered; times a colour. Repeatable; groups that "
         "are not named keep 1"},
        {"Output", SectionTitle{}},
        {"-o FILE", &c.output,
         ".hdr .pic: Radiance picture; .exr: float; .png .jpg: for the screen. Without -o a "
         "Radiance picture goes to standard output"},
        {"--exposure auto|EV", exposure_option(c.tone),
         "for .png and .jpg: average brightness, or a fixed number of stops"},
        {"Help", SectionTitle{}},
        {"--help", answered, "this text"},
        {"--version", answered, "the version of Lightwalk"}};
    return {{c.common.command, kRelight}, {own}, {}};
}

/// A file of layers, and what its header says.
struct LayersFile {
    std::string path, bytes;
    LayersHeader header;
};

LayersFile open_layers(const std::string& path) {
    LayersFile file{path, real_files()->read(path), {}};
    file.header = read_layers_header(file.bytes, path);
    return file;
}

/// Which file holds which group. Throws InputError for files that do not belong together.
std::map<std::string, std::string> group_places(const std::vector<LayersHeader>& headers,
                                                const std::vector<std::string>& paths) {
    std::map<std::string, std::string> places;
    for (std::size_t i = 0; i < headers.size(); ++i) {
        const LayersHeader &first = headers.front(), &own = headers[i];
        if (own.width != first.width || own.height != first.height)
            throw InputError({paths[i], 0}, "is " + std::to_string(own.width) + " by " +
                                                std::to_string(own.height) +
                                                " pixels, expected as many as " + paths.front() +
                                                " has: " + std::to_string(first.width) + " by " +
                                                std::to_string(first.height));
        for (const std::string& name : own.names) {
            const auto [place, is_new] = places.emplace(name, paths[i]);
            if (!is_new)
                throw InputError({paths[i], 0}, "light group \"" + name + "\" is in " +
                                                    place->second + " as well");
        }
    }
    return places;
}

/// Throws InputError for levels of groups that are nowhere.
void expect_groups(const std::map<std::string, Rgb>& levels,
                   const std::map<std::string, std::string>& places) {
    std::string known;
    for (const auto& [name, path] : places) known += (known.empty() ? "" : " ") + name;
    for (const auto& [name, level] : levels) {
        if (!places.contains(name))
            throw InputError("no layer has light group \"" + name + "\": there is " + known);
    }
}

/// One file is in memory at a time.
Picture mixture(const RelightCommand& command, const std::vector<LayersHeader>& headers) {
    const LayersHeader& first = headers.front();
    Picture sum{first.width, first.height, {}};
    sum.pixels.resize(static_cast<std::size_t>(sum.width) * static_cast<std::size_t>(sum.height));
    const std::vector<std::string>& paths = command.common.scene_files();
    for (std::size_t i = 0; i < headers.size(); ++i) {
        std::vector<Rgb> factors;
        for (const std::string& name : headers[i].names) {
            const auto level = command.levels.find(name);
            factors.push_back(level != command.levels.end() ? level->second : Rgb::grey(1));
        }
        const LayersFile file = open_layers(paths[i]);
        if (file.header.names != headers[i].names || file.header.width != first.width ||
            file.header.height != first.height)
            throw InputError({paths[i], 0}, "has changed while it was read");
        add_layers(file.bytes, paths[i], factors, sum);
    }
    return sum;
}

}  // namespace

OptionTable relight_option_table() {
    return owning_table(RelightCommand{}, relight_table);
}

int run_relight(const std::vector<std::string>& line, Communicator* /*ranks*/) {
    RelightCommand command;
    read_command_line(OptionWords(line), relight_table(command), command.common);
    const std::vector<std::string>& paths = command.common.scene_files();
    if (paths.empty()) throw UsageError("name the layers' files");
    if (std::ranges::find(paths, "-") != paths.end())
        throw UsageError("layers are files: standard input is none");
    if (!command.output.empty()) check_picture_name(command.output);
    if (command.output.empty() && isatty(STDOUT_FILENO) != 0)
        throw UsageError("standard output is a terminal: name the picture's file with -o");
    std::vector<LayersHeader> headers;
    headers.reserve(paths.size());
    for (const std::string& path : paths) headers.push_back(open_layers(path).header);
    expect_groups(command.levels, group_places(headers, paths));
    const Picture picture = mixture(command, headers);
    PictureHeader header{headers.front().lines};
    header.lines.push_back(command.common.request.history);
    if (command.output.empty())
        write_to_stdout(encode_hdr(picture, header));
    else
        write_picture(command.output, picture, header, command.tone);
    return kSuccessStatus;
}

}  // namespace lightwalk
