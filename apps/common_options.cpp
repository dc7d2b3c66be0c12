#include "apps/common_options.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string_view>
#include <utility>

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
CustomOption ablated(CommonOptions& options, RenderOptions& light) {
    return {[&options, &light](OptionWords& words) {
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
            options.ablation.*technique->second = false;
        }
        light.ablation = options.ablation;
    }};
}

std::vector<OptionRow> own_rows(CommonOptions& o, RenderOptions& light) {
    constexpr const char* kThreads = "1 to 4096 threads";
    return {
        {"Threads, random numbers, light samples", SectionTitle{"render"}},
        {"-n N", &o.workers, "threads |",
         With{.least = 1, .most = 4096, .expected = kThreads, .shown = "all cores"}},
        {"--seed N", &light.seed,
         "random seed | other random numbers; the same seed gives the same bytes (with -ab: see "
         "--deterministic)"},
        {"--ambient-lights N", &light.ambient_lights,
         "lights sampled where ambient rays arrive | where the rays of indirect light arrive, N "
         "light samples, chosen by what they may bring, stand for all: the same mean, little more "
         "noise; 0: all are tested",
         With{.least = 0, .expected = "a number, 0 for all"}},
        {"--executor WHAT",
         choice(o.executor, {{"serial", ExecutorKind::serial},
                             {"threads", ExecutorKind::threads},
                             {"tbb", ExecutorKind::tbb}}),
         "what runs the work: serial: one thread; threads: the standard library's; tbb: oneTBB"},
        {"Messages and statistics", SectionTitle{"render"}},
        {"-e FILE", error_file(o.error_file), "append messages to FILE"},
        {"--stats FILE.json", &o.stats_file,
         "seconds to read, build and render, rays by kind, rays per second, memory"},
        {"--quiet", &o.quiet, "no progress, no warnings; -w- alone: no warnings"},
        {"Scene", SectionTitle{"render"}},
        {"--allow-commands", &o.allow_commands,
         "run commands in scene files that Lightwalk does not replace by its own generators"},
        {"--stale", &o.stale_allowed,
         "take a frozen scene whose files have changed since it was frozen"},
        {"--ablate WORDS", ablated(o, light), "do without techniques that change the speed only",
         With{.hidden = true}}};
}

}  // namespace

std::vector<OptionRow> common_option_rows(CommonOptions& options, RenderSettings& settings,
                                          bool* show_defaults) {
    std::vector<OptionRow> rows = own_rows(options, settings.light);
    for (OptionRow& row : rank_option_rows(options.ranks)) rows.push_back(std::move(row));
    const Action answered{[] {}};  // by main, wherever they stand
    rows.push_back({"Help", SectionTitle{}});
    if (show_defaults != nullptr)
        rows.push_back({"-defaults", show_defaults,
                        "print all options with their values, as the words before it set them"});
    rows.push_back({"--help", answered, "this text"});
    rows.push_back({"--version", answered, "the version of Lightwalk"});
    return rows;
}

void parse_options(OptionWords& words, const OptionTable& table, CommonOptions& options,
                   const bool& stop) {
    while (!stop && words.at_option()) {
        const std::string& word = words.option();
        if (word.empty() || word.front() != '-' || word == "-") {
            options.scene_positions.push_back(words.position());
            options.scene_files.push_back(word);
            words.skip(1);
        } else if (!table.take(words)) {
            table.refuse(words);
        }
    }
}

void resolve_scene_files(CommonOptions& options, const std::string& taken_by, FileSource& input) {
    std::vector<std::string>& files = options.scene_files;
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

void redirect_messages(const CommonOptions& options, const std::string& history) {
    if (options.error_file.empty()) return;
    if (std::freopen(options.error_file.c_str(), "a", stderr) == nullptr) {
        throw InputError({options.error_file, 0}, "cannot open the error file");
    }
    std::fprintf(stderr, "**************\n*** PID %ld: %s\n", static_cast<long>(getpid()),
                 history.c_str());
}

std::string command_history(const std::string& command, const OptionWords& words,
                            const CommonOptions& options) {
    std::vector<std::string> all = words.expanded();
    for (auto at = options.scene_positions.rbegin(); at != options.scene_positions.rend(); ++at) {
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(*at));
    }
    return history_line(std::vector<std::string>{"lightwalk", command}) +
           (all.empty() ? std::string() : ' ' + history_line(all));
}

}  // namespace lightwalk
