// lightwalk freeze: a scene, with all that a run needs of it, in one file.
#include <filesystem>
#include <string>
#include <system_error>

#include "apps/commands.h"
#include "apps/common_options.h"
#include "apps/rad_command.h"
#include "apps/session/lightwalk/scene.h"
#include "apps/warnings.h"
#include "io/files/atomic_file.h"

namespace lightwalk {
namespace {

struct FreezeCommand {
    CommonOptions common{"freeze"};
    std::string output;  ///< -o
};

OptionTable freeze_table(FreezeCommand& c) {
    const std::vector<OptionRow> own{
        {"Output", SectionTitle{}},
        {"-o FILE", &c.output,
         "the frozen scene; a file of that name is replaced when the new one is whole"}};
    return {{c.common.command, kFreeze},
            {own, common_option_rows(c.common)},
            {"-n", "--allow-commands", "--quiet"}};
}

/// Throws UsageError or InputError unless the file may be written.
void check_frozen_output(const std::string& output, const std::vector<std::string>& scene_files) {
    if (output.empty()) throw UsageError("name the frozen scene's file with -o");
    for (const std::string& scene : scene_files) {
        std::error_code none;
        if (std::filesystem::equivalent(scene, output, none))
            throw UsageError("option -o: " + output + " is a file of the scene");
    }
    check_writable(output);
}

}  // namespace

OptionTable freeze_option_table() {
    return owning_table(FreezeCommand{}, freeze_table);
}

int run_freeze(const std::vector<std::string>& line, Communicator* /*ranks*/) {
    FreezeCommand command;
    CommonOptions& options = command.common;
    read_command_line(OptionWords(line), freeze_table(command), options);
    StderrWarnings warnings(options.program());
    warnings.enable(!options.quiet);
    if (const auto plan = named_rad_plan(options, *real_files())) {
        take_rad_scene(*plan, options);
        for (const std::string& notice : plan->notices) warnings.warn(notice);
    }
    check_frozen_output(command.output, options.scene_files());
    resolve_scene_files(options, "", *real_files());
    freeze_scene(options.request.source, command.output,
                 [&](const std::string& message) { warnings.warn(message); });
    return kSuccessStatus;
}

}  // namespace lightwalk
