// lightwalk freeze: a scene, with all that a run needs of it, in one file.
#include <filesystem>
#include <string>
#include <system_error>

#include "apps/commands.h"
#include "apps/renderer_request.h"
#include "apps/session/lightwalk/scene.h"
#include "apps/warnings.h"

namespace lightwalk {
namespace {

constexpr const char* kFreezeProgram = "lightwalk freeze";

struct FreezeCommand {
    RenderSettings settings = default_render_settings(OptionDefaults::rpict);
    CommonOptions common;
    std::string output;  ///< -o
};

OptionTable table_of(FreezeCommand& c) {
    const std::vector<OptionRow> own{
        {"Output", SectionTitle{}},
        {"-o FILE", &c.output,
         "the frozen scene; a file of that name is replaced when the new one is whole"}};
    return {{"freeze", kFreeze},
            {own, common_option_rows(c.common, c.settings, nullptr)},
            {"-n", "--allow-commands", "--quiet"}};
}

/// Throws UsageError unless the file may be written.
void check_frozen_output(const std::string& output, const CommonOptions& options) {
    if (output.empty()) throw UsageError("name the frozen scene's file with -o");
    for (const std::string& scene : options.scene_files) {
        std::error_code none;
        if (std::filesystem::equivalent(scene, output, none))
            throw UsageError("option -o: " + output + " is a file of the scene");
    }
}

}  // namespace

OptionTable freeze_option_table() {
    return owning_table(FreezeCommand{}, table_of);
}

int run_freeze(const std::vector<std::string>& line, Communicator* /*ranks*/) {
    FreezeCommand command;
    const CommonOptions& options = command.common;
    const std::string& output = command.output;
    OptionWords words(line);
    parse_options(words, table_of(command), command.common, false);
    check_frozen_output(output, options);
    StderrWarnings warnings(kFreezeProgram);
    warnings.enable(!options.quiet);
    resolve_scene_files(command.common, "", *real_files());
    freeze_scene(scene_source(options), output,
                 [&](const std::string& message) { warnings.warn(message); });
    return kSuccessStatus;
}

}  // namespace lightwalk
