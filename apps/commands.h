#pragma once
// The commands of the program, and what it exits with.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/options/option_rows.h"

namespace lightwalk {

class Communicator;
class ResidentScene;

/// The environment variables by which `launch` tells a walk its token, and the name of the machine
/// on which the walk's head is: the page is served there, and rank 0 listens for the head alone, on
/// any port, of which it prints the address.
inline constexpr const char *kWalkToken = "LIGHTWALK_WALK_TOKEN",
                            *kWalkHead = "LIGHTWALK_WALK_HEAD", *kWalkKept = "LIGHTWALK_WALK_KEPT";

inline constexpr int kSuccessStatus = 0;
inline constexpr int kFailureStatus = 1;  ///< bad input, or output that could not be written
inline constexpr int kUsageStatus = 2;    ///< a command line that was not understood

/// Each takes the words after its name and returns the exit status. They throw UsageError and
/// InputError.
/// @param ranks  the wire to the other ranks; null: this process is alone
int run_render(const std::vector<std::string>& words, Communicator* ranks);
int run_animate(const std::vector<std::string>& words, Communicator* ranks);
int run_walk(const std::vector<std::string>& words, Communicator* ranks);
int run_trace(const std::vector<std::string>& words, Communicator* ranks);
int run_contrib(const std::vector<std::string>& words, Communicator* ranks);
int run_relight(const std::vector<std::string>& words, Communicator* ranks);
int run_freeze(const std::vector<std::string>& words, Communicator* ranks);
int run_info(const std::vector<std::string>& words, Communicator* ranks);
int run_launch(const std::vector<std::string>& words, Communicator* ranks);
int run_install_names(const std::vector<std::string>& words, Communicator* ranks);
// The same by the names of Radiance's programs, which messages and headers have: as many threads as
// these have processes, and commands in scene files are run.
int run_rpict(const std::vector<std::string>& words, Communicator* ranks);
int run_rtrace(const std::vector<std::string>& words, Communicator* ranks);
int run_rcontrib(const std::vector<std::string>& words, Communicator* ranks);
/// run_rtrace(), which does not read the scene where it is this one.
int run_rtrace_on(const std::shared_ptr<const ResidentScene>& scene,
                  const std::vector<std::string>& words);

/// The commands in With::commands.
inline constexpr unsigned kRender = 1, kAnimate = 2, kWalk = 4, kTrace = 8, kFreeze = 16,
                          kInfo = 32, kContrib = 64, kRelight = 128, kInstallNames = 256,
                          kLaunch = 512;

/// The options of each, with their defaults.
[[nodiscard]] OptionTable freeze_option_table();
[[nodiscard]] OptionTable info_option_table();
[[nodiscard]] OptionTable relight_option_table();
[[nodiscard]] OptionTable launch_option_table();
[[nodiscard]] OptionTable install_names_option_table();

struct Command {
    const char* name;
    const char* summary;  ///< for the program's help
    int (*run)(const std::vector<std::string>& words, Communicator* ranks);
    OptionTable (*options)();  ///< with their defaults
    const char* about;         ///< its help before the options
    const char* example;       ///< its help behind the options
    bool shared = true;        ///< ranks share its work; else rank 0 does it alone
};
[[nodiscard]] std::span<const Command> commands();
/// Null: there is no such command.
[[nodiscard]] const Command* find_command(const std::string& name);

/// Help texts: of the program (""), of each command, and of "options": all options of all commands,
/// as a document in Markdown.
[[nodiscard]] std::string help_text(const std::string& command);

/// The page for man(1) of a command, or of the program (""). Throws UsageError where there is no
/// such command.
[[nodiscard]] std::string manual_text(const std::string& command);

}  // namespace lightwalk
