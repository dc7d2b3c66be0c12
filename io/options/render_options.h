#pragma once
// Radiance's rendering options: how light is followed, as rpict and rtrace take it from the command
// line.
#include <functional>
#include <string>
#include <vector>

#include "core/transport/options.h"
#include "io/files/library_path.h"
#include "io/options/option_rows.h"

namespace lightwalk {

/// All that these options set.
struct RenderSettings {
    RenderOptions light;        ///< what the core needs
    std::string ambient_file;   ///< -af, "" for none
    bool uncorrelated = false;  ///< -u; every sample is independent anyway, so it changes nothing
    bool warnings = true;       ///< -w
};

/// Whose defaults: they differ. Source: the manual pages rpict(1), rtrace(1) and rcontrib(1).
enum class OptionDefaults { rpict, rtrace, rcontrib };
[[nodiscard]] RenderSettings default_render_settings(OptionDefaults program);

/// The rows of all rendering options, and of Radiance's that Lightwalk refuses by name (photon
/// maps, spectra, colours weighted by other eyes, global function definitions).
/// @param settings  what they set; must outlive the rows
/// @param library   where modifier lists (-aE, -aI) are looked for
[[nodiscard]] std::vector<OptionRow> render_option_rows(RenderSettings& settings,
                                                        const LibraryPath& library);

/// Take the option that stands in option position, with its arguments, if it is a rendering option;
/// false leaves `words` as it is. Throws UsageError for wrong arguments and for refused options,
/// InputError when a modifier list (-aE, -aI) cannot be read.
[[nodiscard]] bool parse_render_option(OptionWords& words, const LibraryPath& library,
                                       RenderSettings& settings);

/// What can only be told when all options are known: throws UsageError for -lr <= 0 with -lw <= 0.
void check_render_settings(const RenderSettings& settings);

/// Adds the names of modifiers to a list.
using AddNames = std::function<void(const std::vector<std::string>& names)>;
/// An option, as -ae, whose argument is such a name.
[[nodiscard]] CustomOption name_option(AddNames add);
/// An option, as -aE, whose argument is a file along the library path: its white-space separated
/// words are names. Taking it throws InputError when the file cannot be read.
[[nodiscard]] CustomOption names_option(AddNames add, const LibraryPath& library);

/// The lines of these options as `-defaults` prints them.
[[nodiscard]] std::string describe_render_settings(const RenderSettings& settings);

}  // namespace lightwalk
