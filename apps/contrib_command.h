#pragma once
// The options of `lightwalk contrib`, read from a command line.
#include <memory>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "io/contributions/bin_definitions.h"
#include "io/contributions/contribution_files.h"
#include "io/contributions/contribution_tally.h"
#include "io/rays/ray_reader.h"

namespace lightwalk {

/// The options of which the last ones before -m hold for its modifier.
struct ModifierRequest {
    std::string name;
    std::string output;      ///< -o
    std::string bin = "0";   ///< -b
    std::string parameters;  ///< -p
    int bins = 0;            ///< -bn; 0: it was not given
};

struct ContribCommand {
    CommonOptions common{"contrib", OptionDefaults::rcontrib};
    bool header = true;                                  ///< -h
    RayFormats formats;                                  ///< -fXY
    int x = 0, y = 0;                                    ///< -x -y
    int rays = 1;                                        ///< -c
    bool values = false;                                 ///< -V
    bool cache = false;                                  ///< --cache
    ExistingOutputs existing = ExistingOutputs::refuse;  ///< -fo -r
    BinDefinitions definitions;                          ///< -e -f
    ModifierRequest next;                                ///< as far as it is known
    bool next_open = false;                  ///< what was said of it holds for no modifier yet
    std::vector<ModifierRequest> modifiers;  ///< -m -M
};

/// The options of contrib, which set the command's members; must not outlive it.
/// @param files  where those are that options name
[[nodiscard]] OptionTable option_table(ContribCommand& command,
                                       const std::shared_ptr<FileSource>& files);

/// Whose contributions are asked for, in order. Throws UsageError where none is, and for options
/// that hold for none.
[[nodiscard]] std::vector<TrackedModifier> tracked_modifiers(const ContribCommand& command);
/// Sets what follows from other options: contributions come neither from ambient values nor from
/// differences. Throws UsageError for options that do not go together.
void settle_contrib_command(ContribCommand& command, const std::vector<TrackedModifier>& tracked,
                            WarningSink& warnings);
/// How many rays are given to the renderer at once: their answers have to be in memory.
[[nodiscard]] std::size_t rays_at_once(const ContribCommand& command,
                                       const std::vector<TrackedModifier>& tracked);

}  // namespace lightwalk
