#include "apps/common_options.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "core/model/transform_args.h"
#include "parallel/executor.h"

namespace lightwalk {
namespace {

CustomOption error_file(std::string& file) {
    return {[&file](OptionWords& words) {
        file = words.text();
        if (file.find_first_of("=:") != std::string::npos)
            throw UsageError(
                "option -e: global definitions are not supported, only the name of a file for "
                "messages");
    }};
}

constexpr std::array<std::pair<std::string_view, bool Ablation::*>, 6> kTechniques{
    {{"batches", &Ablation::batches},
     {"function-lanes", &Ablation::function_lanes},
     {"sample-lanes", &Ablation::sample_lanes},
     {"leaves", &Ablation::leaves},
     {"slices", &Ablation::slices},
     {"packets", &Ablation::packets}}};

/// Techniques to do without, by their names with commas between them.
CustomOption ablated(CommonOptions& o) {
    return {[&o](OptionWords& words) {
        Ablation& ablation = o.request.source.ablation;
        std::istringstream names(words.text());
        for (std::string name; std::getline(names, name, ',');) {
            const auto* const technique =
                std::ranges::find_if(kTechniques, [&](const auto& t) { return t.first == name; });
            if (technique == kTechniques.end()) {
                std::string expected;
                for (const auto& [known, _] : kTechniques)
                    expected += (expected.empty() ? "" : ", ") + std::string(known);
                refuse_argument("--ablate", "some of " + expected, '"' + name + '"');
            }
            ablation.*technique->second = false;
        }
        o.settings.light.ablation = ablation;
    }};
}

/// "program command option ..." without the scene's files, as history lines have it.
std::string command_history(const OptionWords& words, const CommonOptions& options) {
    std::vector<std::string> all = words.expanded();
    for (auto at = options.scene_positions.rbegin(); at != options.scene_positions.rend(); ++at)
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(*at));
    return options.program() + (all.empty() ? "" : ' ' + history_line(all));
}

}  // namespace

CommonOptions::CommonOptions(std::string name, OptionDefaults program)
    : command(std::move(name)), settings(default_render_settings(program)) {
    set_threads(hardware_threads());
    request.source.trim_heap = true;  // the process is all ours
    request.options.executor = kDefaultExecutor;
    request.options.stop = &interrupt_flag();
}

RendererOptions renderer_options(const CommonOptions& options) {
    RendererOptions all = options.request.options;
    all.light = options.settings.light;
    all.ambient_file = options.settings.ambient_file;
    return all;
}

std::vector<OptionRow> common_option_rows(CommonOptions& o) {
    RenderOptions& light = o.settings.light;
    RendererOptions& renderer = o.request.options;
    std::vector<OptionRow> rows{
        {"Threads, random numbers, light samples", SectionTitle{"render"}},
        {"-n N", &renderer.threads, "threads |",
         With{.least = 1,
              .most = 4096,
              .expected = "1 to 4096 threads",
              .shown = "all cores",
              .then = [&o] { o.set_threads(o.request.options.threads); }}},
        {"--seed N", &light.seed,
         "random seed | other random numbers; the same seed gives the same bytes (with -ab: see "
         "--deterministic)"},
        {"--ambient-lights N", &light.ambient_lights,
         "lights sampled where ambient rays arrive | where the rays of indirect light arrive, N "
         "light samples, chosen by what they may bring, stand for all: the same mean, little more "
         "noise; 0: all are tested",
         With{.least = 0, .expected = "a number, 0 for all"}},
        {"--executor WHAT",
         choice(renderer.executor, {{"serial", ExecutorKind::serial},
                                    {"threads", ExecutorKind::threads},
                                    {"tbb", ExecutorKind::tbb}}),
         "what runs the work: serial: one thread; threads: the standard library's; tbb: oneTBB"},
        {"Messages and statistics", SectionTitle{"render"}},
        {"-e FILE", error_file(o.error_file), "append messages to FILE",
         With{.commands = ~kContrib}},
        {"--stats FILE.json", &o.stats_file,
         "seconds to read, build and render, rays by kind, rays per second, memory"},
        {"--quiet", &o.quiet, "no progress, no warnings; -w- alone: no warnings"},
        {"Scene", SectionTitle{"render"}},
        {"--allow-commands", &o.request.source.allow_commands,
         "run commands in scene files that Lightwalk does not replace by its own generators"},
        {"--stale", &o.request.source.allow_stale,
         "take a frozen scene whose files have changed since it was frozen"},
        {"--ablate WORDS", ablated(o), "do without techniques that change the speed only",
         With{.hidden = true}}};
    for (OptionRow& row : rank_option_rows(o.ranks)) rows.push_back(std::move(row));
    const Action answered{[] {}};  // by main, wherever they stand
    rows.insert(rows.end(),
                {{"Help", SectionTitle{}},
                 {"-defaults", &o.show_defaults,
                  "print all options with their values, as the words before it set them",
                  With{.commands = kRender | kAnimate | kWalk | kTrace | kContrib}},
                 {"--help", answered, "this text"},
                 {"--version", answered, "the version of Lightwalk"}});
    return rows;
}

CustomOption exposure_option(ToneMapping& tone) {
    const auto take = [&tone](OptionWords& words) {
        const std::string word = words.text();
        tone.automatic = word == "auto";
        if (!tone.automatic && !parse_real(word, tone.ev))
            refuse_argument("--exposure", "auto or a number of stops (EV)", '"' + word + '"');
    };
    return {take, [&tone] { return tone.automatic ? "auto" : std::to_string(tone.ev); }};
}

void read_command_line(OptionWords words, const OptionTable& table, CommonOptions& options) {
    while (!options.show_defaults && words.at_option()) {
        const std::string& word = words.option();
        if (word.empty() || word.front() != '-' || word == "-") {
            options.scene_positions.push_back(words.position());
            options.request.source.files.push_back(word);
            words.skip(1);
        } else if (!table.take(words)) {
            table.refuse(words);
        }
    }
    options.request.history = command_history(words, options);
}

void resolve_scene_files(CommonOptions& options, const std::string& taken_by, FileSource& input) {
    std::vector<std::string>& files = options.request.source.files;
    if (!taken_by.empty()) {
        if (files.empty()) {
            throw UsageError("no scene: name an octree or scene files; standard input holds " +
                             taken_by);
        }
        if (std::find(files.begin(), files.end(), "-") != files.end())
            throw UsageError("standard input holds " + taken_by + ", so the scene cannot be -");
    }
    if (!files.empty()) return;
    const std::string state =
        input.answer(FileSource::Question::input_state, "standard input", 0).value_or("empty");
    if (state == "terminal") {
        throw UsageError(
            "no scene: name an octree or scene files, or send one of them to standard input");
    }
    if (state == "empty")
        throw UsageError("no scene: none is named, and standard input holds nothing");
    files.emplace_back("-");
}

}  // namespace lightwalk
