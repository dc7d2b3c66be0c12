#pragma once
// Command lines whose scene is a rad file: it names the scene's files, views and options, and what
// stands on the command line comes before what it says.
#include <memory>
#include <string>
#include <vector>

#include "apps/contrib_command.h"
#include "apps/render_command.h"
#include "apps/trace_command.h"
#include "io/rad/rad_plan.h"

namespace lightwalk {

using RadPlanPtr = std::shared_ptr<const RadPlan>;

/// The rad file among the scene's files, with the variables that other words assign (QUALITY=High),
/// as rad(1) takes them; null: there is none. Throws UsageError for files beside it, InputError for
/// what is wrong in it.
[[nodiscard]] RadPlanPtr named_rad_plan(const CommonOptions& options, FileSource& files);

/// The scene's files are those of the plan; the command line's history keeps the rad file's name.
void take_rad_scene(const RadPlan& plan, CommonOptions& options);

/// How light is followed, where the scene is not needed to tell. Throws InputError for options that
/// are none.
void take_rad_light(const RadPlan& plan, RenderSettings& settings,
                    const std::shared_ptr<FileSource>& files);
/// All options that rad(1) gives rpict(1), but for views and sizes.
[[nodiscard]] std::vector<std::string> rad_option_words(const RadPlan& plan, const Scene& scene);
/// The rest, once the scene is compiled, as far as take_rad_light left it open.
void settle_rad_light(const RadPlan& plan, const Scene& scene, RenderOptions& light);

// What a command takes of a plan, as if it stood before the words of its command line; to be called
// on a command with its defaults. `view`: what -v says. Throw InputError for options that are none.
void take_rad_plan(const RadPlan& plan, const std::string& view, RenderCommand& command,
                   const std::shared_ptr<FileSource>& files);
void take_rad_plan(const RadPlan& plan, const std::string& view, TraceCommand& command,
                   const std::shared_ptr<FileSource>& files);
void take_rad_plan(const RadPlan& plan, const std::string& view, ContribCommand& command,
                   const std::shared_ptr<FileSource>& files);
// What comes behind these words.
void finish_rad_plan(const RadPlanPtr& plan, const std::string& view, RenderCommand& command,
                     const std::shared_ptr<FileSource>& files);
void finish_rad_plan(const RadPlanPtr& plan, const std::string& view, TraceCommand& command,
                     const std::shared_ptr<FileSource>& files);
void finish_rad_plan(const RadPlanPtr& plan, const std::string& view, ContribCommand& command,
                     const std::shared_ptr<FileSource>& files);

[[nodiscard]] inline std::string rad_view_of(const RenderCommand& command) {
    return command.rad_view;
}
[[nodiscard]] inline std::string rad_view_of(const TraceCommand& /*command*/) {
    return {};
}
[[nodiscard]] inline std::string rad_view_of(const ContribCommand& /*command*/) {
    return {};
}

/// Read a command line, over a rad file where it names one. Throws UsageError, InputError.
/// @param command  with the defaults of its options, which option_table(command, files) sets
/// @param source   where those are that the words name
template <class Command>
OptionTable take_command_line(Command& command, const std::vector<std::string>& words,
                              const std::shared_ptr<FileSource>& source) {
    // With a rad file words are read twice, which must find the same.
    const auto files = std::make_shared<FileRecorder>(source, true);
    const Command fresh = command;
    const auto read = [&] {
        OptionTable table = option_table(command, files);
        read_command_line(OptionWords(words, files), table, command.common);
        return table;
    };
    OptionTable table = read();
    const RadPlanPtr plan = named_rad_plan(command.common, *files);
    const std::string view = rad_view_of(command);
    if (!plan && !view.empty())
        throw UsageError("option -v: it names a view of a rad file: expected one (scene.rif)");
    if (!plan) return table;
    command = fresh;
    take_rad_plan(*plan, view, command, files);
    table = read();
    finish_rad_plan(plan, view, command, files);
    return table;
}

}  // namespace lightwalk
