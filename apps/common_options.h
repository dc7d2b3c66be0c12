#pragma once
// Options and habits that all commands share.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/rank_options.h"
#include "core/error.h"
#include "io/options/option_words.h"
#include "io/options/render_options.h"
#include "parallel/executor.h"

namespace lightwalk {

struct CommonOptions {
    int workers = hardware_threads();  ///< -n
    RankOptions ranks;
    ExecutorKind executor = kDefaultExecutor;  ///< --executor
    bool allow_commands = false;               ///< --allow-commands
    bool stale_allowed = false;                ///< --stale
    bool quiet = false;                        ///< --quiet
    std::string stats_file;                    ///< --stats
    std::string error_file;                    ///< -e: where messages go, "" for standard error
    std::vector<std::string> scene_files;      ///< words that are no options, in order
    std::vector<std::size_t> scene_positions;  ///< where they stand among the expanded words
};

/// Take one of these options, or a scene's name; false when the word is something else.
[[nodiscard]] bool parse_common_option(OptionWords& words, CommonOptions& options,
                                       RenderSettings& settings);

/// The word in option position is none that the command knows: throws UsageError with the nearest
/// of `names`.
[[noreturn]] void refuse_option(const OptionWords& words, std::vector<std::string> names);

/// Names of the options above, for suggestions.
[[nodiscard]] std::vector<std::string> common_option_names();

/// Without a scene on the command line, standard input is the scene, as for Radiance's rpict: adds
/// "-". `taken_by`: what standard input holds for the command already, "the rays"; "" for nothing.
/// Throws UsageError when there is no scene: standard input is taken, a terminal or empty.
void resolve_scene_files(CommonOptions& options, const std::string& taken_by, FileSource& files);

/// Append messages to the file that -e names, from here on. Throws InputError.
void redirect_messages(const CommonOptions& options, const std::string& history);

/// "program command option ..." without the scene's files, as history lines have it.
[[nodiscard]] std::string command_history(const std::string& command, const OptionWords& words,
                                          const CommonOptions& options);
/// The header lines of a result: the scene's own, the command's, SOFTWARE=.
[[nodiscard]] std::vector<std::string> history_header(const std::vector<std::string>& scene_header,
                                                      const std::string& command_line);
/// CAPDATE= and GMT= of now.
[[nodiscard]] std::vector<std::string> date_lines();

}  // namespace lightwalk
