#include "apps/trace_command.h"

#include <optional>
#include <utility>

namespace lightwalk {
namespace {

const std::vector<std::string> kOwnNames{"-h",  "-I",  "-ld",  "-x",  "-y",    "-fa",
                                         "-ff", "-fd", "-fac", "-ov", "-pRGB", "-pXYZ",
                                         "-pY", "-pA", "-te",  "-ti", "-tE",   "-tI"};

bool parse_switch(OptionWords& words, TraceCommand& command) {
    for (const auto& [name, place] :
         {std::pair{"-h", &command.header}, std::pair{"-I", &command.sensor},
          std::pair{"-ld", &command.limit_by_length}}) {
        if (const std::optional<bool> value = words.toggle(name, *place)) {
            *place = *value;
            return true;
        }
    }
    return false;
}

std::optional<ColorOutput> color_output(const std::string& word) {
    if (word == "-pRGB") return ColorOutput::rgb;
    if (word == "-pXYZ") return ColorOutput::xyz;
    if (word == "-pY") return ColorOutput::luminance;
    if (word == "-pA") return ColorOutput::mean;
    if (word == "-pc") {
        throw UsageError(
            "option -pc converts to other primaries, which is not supported; the choices are "
            "-pRGB, -pXYZ, -pY and -pA");
    }
    return std::nullopt;
}

bool parse_tree_option(OptionWords& words, const LibraryPath& library, TreeSelection& tree) {
    const std::string word = words.option();
    if (word != "-te" && word != "-ti" && word != "-tE" && word != "-tI") return false;
    using Kind = TreeSelection::Kind;
    const Kind kind = word[2] == 'e' || word[2] == 'E' ? Kind::exclude : Kind::include;
    const std::string name = words.text();
    const bool is_file = word[2] == 'E' || word[2] == 'I';
    tree.add(kind, is_file ? names_in_file(name, library) : std::vector<std::string>{name});
    return true;
}

bool parse_own_option(OptionWords& words, TraceCommand& command) {
    const std::string word = words.option();
    if (word == "-x")
        command.x = words.integer();
    else if (word == "-y")
        command.y = words.integer();
    else if (const auto formats =
                 word.starts_with("-f") ? parse_ray_formats(word.substr(2)) : std::nullopt) {
        command.formats = *formats;
        words.skip(1);
    } else if (word.starts_with("-o")) {
        command.letters = word.substr(2);
        words.skip(1);
    } else if (const auto color = color_output(word)) {
        command.color = *color;
        words.skip(1);
    } else {
        return parse_switch(words, command);
    }
    return true;
}

}  // namespace

TraceCommand parse_trace_command(const std::vector<std::string>& line,
                                 const std::shared_ptr<FileSource>& files) {
    TraceCommand command;
    const LibraryPath library = LibraryPath::from_environment(files);
    OptionWords words(line, files);
    while (words.at_option()) {
        if (words.option() == "-defaults") {
            command.show_defaults = true;
            return command;
        }
        if (words.option() == "-P" || words.option() == "-PP") {
            throw UsageError("option " + words.option() +
                             ": persistent processes are not supported");
        }
        if (parse_own_option(words, command) || parse_tree_option(words, library, command.tree) ||
            parse_render_option(words, library, command.settings) ||
            parse_common_option(words, command.common, command.settings)) {
            continue;
        }
        std::vector<std::string> names = render_option_names();
        names.insert(names.end(), kOwnNames.begin(), kOwnNames.end());
        refuse_option(words, std::move(names));
    }
    command.history = command_history("trace", words, command.common);
    return command;
}

std::string describe(const TraceCommand& c) {
    std::string text = option_line("-o" + c.letters, "output fields");
    text += option_line(option_text("-h", c.header), "output header");
    text += option_line(option_text("-I", c.sensor), "rays are points and normals: irradiance");
    text +=
        option_line(option_text("-ld", c.limit_by_length), "a direction's length limits its ray");
    text += option_line(option_text("-x", c.x), "flush interval");
    text += option_line(option_text("-y", c.y), "rows");
    text += describe_render_settings(c.settings);
    text += option_line(option_text("-n", c.common.workers), "threads");
    text += option_line("--seed " + std::to_string(c.settings.light.seed), "random seed");
    text += option_line("--ambient-lights " + std::to_string(c.settings.light.ambient_lights),
                        "lights sampled where ambient rays arrive");
    return text;
}

}  // namespace lightwalk
