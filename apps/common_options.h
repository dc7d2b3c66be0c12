#pragma once
// What all commands share: options, the scene's files, the header lines of results.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/rank_options.h"
#include "core/ablation.h"
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
    Ablation ablation;                         ///< --ablate, for tests and benchmarks
    std::string stats_file;                    ///< --stats
    std::string error_file;                    ///< -e: where messages go, "" for standard error
    std::vector<std::string> scene_files;      ///< words that are no options, in order
    std::vector<std::size_t> scene_positions;  ///< where they stand among the expanded words
};

/// The rows of these options, and of those on ranks.
/// @param show_defaults  what -defaults sets; null: the command has none
/// All that they set must outlive the rows.
[[nodiscard]] std::vector<OptionRow> common_option_rows(CommonOptions& options,
                                                        RenderSettings& settings,
                                                        bool* show_defaults);

/// Take the words of a command line: options, and names of scene files, which `options` collects.
/// Throws UsageError for a word that is no option of the table, with the nearest one.
/// @param stop  ends it when an option has set it
void parse_options(OptionWords& words, const OptionTable& table, CommonOptions& options,
                   const bool& stop);

/// Without a scene on the command line, standard input is the scene, as for Radiance's rpict: adds
/// "-". `taken_by`: what standard input holds for the command already, "the rays"; "" for nothing.
/// Throws UsageError when there is no scene: standard input is taken, a terminal or empty.
void resolve_scene_files(CommonOptions& options, const std::string& taken_by, FileSource& files);

/// Append messages to the file that -e names, from here on. Throws InputError.
void redirect_messages(const CommonOptions& options, const std::string& history);

/// "program command option ..." without the scene's files, as history lines have it.
[[nodiscard]] std::string command_history(const std::string& command, const OptionWords& words,
                                          const CommonOptions& options);

}  // namespace lightwalk
