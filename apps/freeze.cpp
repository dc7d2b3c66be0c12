// lightwalk freeze: a scene, with all that a run needs of it, in one file.
#include <filesystem>
#include <string>
#include <system_error>

#include "apps/commands.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "io/files/file_manifest.h"
#include "io/scene/freezing_resources.h"
#include "io/scene/frozen_scene.h"

namespace lightwalk {
namespace {

constexpr const char* kFreezeProgram = "lightwalk freeze";

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

int run_freeze(const std::vector<std::string>& line, Transport* /*ranks*/) {
    RenderSettings settings = default_render_settings(OptionDefaults::rpict);
    CommonOptions options;
    std::string output;
    OptionWords words(line);
    while (words.at_option()) {
        if (words.option() == "-o")
            output = words.text();
        else if (!parse_common_option(words, options, settings))
            refuse_option(words, {"-o"});
    }
    check_frozen_output(output, options);
    StderrWarnings warnings(kFreezeProgram);
    warnings.enable(!options.quiet);
    resolve_scene_files(options, "", *real_files());
    const auto manifest = std::make_shared<ManifestRecorder>();
    SceneSession session(options, warnings, std::make_shared<FileRecorder>(manifest));
    if (session.frozen != nullptr)
        throw InputError({options.scene_files.front(), 0}, "is frozen already");
    FreezingResources library(*session.resources);
    session.compile(library);
    write_frozen_scene(output, session.scene(), library, manifest->files());
    return kSuccessStatus;
}

}  // namespace lightwalk
