#pragma once
// What the command lines of all commands share: options, and the scene's files.
#include <string>
#include <vector>

#include "apps/rank_options.h"
#include "core/error.h"
#include "io/options/option_words.h"
#include "io/options/render_options.h"
#include "io/picture/tone.h"

namespace lightwalk {

struct CommonOptions {
    /// @param program  whose defaults the rendering options have
    explicit CommonOptions(std::string command, OptionDefaults program = OptionDefaults::rpict);

    std::string command;                       ///< name of the command
    std::string called;                        ///< by another name than "lightwalk COMMAND"; ""
    RendererRequest request;                   ///< the scene's files, -n --executor ...
    RenderSettings settings;                   ///< how light is followed
    RankCommand ranks;                         ///< --variant --block ...
    bool quiet = false;                        ///< --quiet
    bool show_defaults = false;                ///< -defaults
    std::string stats_file;                    ///< --stats
    std::string error_file;                    ///< -e: where messages go, "" for standard error
    std::vector<std::size_t> scene_positions;  ///< of the scene's files among the expanded words
    std::vector<std::string> notices;          ///< warnings of the command line, for the run
    std::vector<std::string> words;            ///< the command line, to be read again

    /// How messages name the program.
    [[nodiscard]] std::string program() const {
        return called.empty() ? "lightwalk " + command : called;
    }
    [[nodiscard]] const std::vector<std::string>& scene_files() const {
        return request.source.files;
    }
    /// Threads that compile the scene and render.
    void set_threads(int threads) { request.source.threads = request.options.threads = threads; }
};

/// What a renderer is asked for, but for warnings.
[[nodiscard]] RendererOptions renderer_options(const CommonOptions& options);

/// The rows of the options that all commands share, and of those on ranks. `options` must outlive
/// the rows.
[[nodiscard]] std::vector<OptionRow> common_option_rows(CommonOptions& options);

/// --exposure auto|EV, of pictures for the screen. `tone` must outlive it.
[[nodiscard]] CustomOption exposure_option(ToneMapping& tone);

/// Read a command line: options of the table, and names of scene files, which `options` collects
/// with the line's history. Stops behind -defaults. Throws UsageError for a word that is no option
/// of the table, with the nearest one.
void read_command_line(OptionWords words, const OptionTable& table, CommonOptions& options);

/// Without a scene on the command line, standard input is the scene, as for Radiance's rpict: adds
/// "-". `taken_by`: what standard input holds for the command already, "the rays"; "" for nothing.
/// Throws UsageError when there is no scene: standard input is taken, a terminal or empty.
void resolve_scene_files(CommonOptions& options, const std::string& taken_by, FileSource& files);

}  // namespace lightwalk
