#include "apps/common_options.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

namespace lightwalk {
namespace {

ExecutorKind executor_kind(const std::string& name) {
    if (name == "serial") return ExecutorKind::serial;
    if (name == "threads") return ExecutorKind::threads;
    if (name == "tbb") return ExecutorKind::tbb;
    throw UsageError("option --executor: expected serial, threads or tbb, found \"" + name + "\"");
}

int worker_count(OptionWords& words) {
    constexpr int kMost = 4096;
    const int count = words.integer();
    if (count < 1 || count > kMost) {
        throw UsageError("option -n: expected 1 to " + std::to_string(kMost) + " threads, found " +
                         std::to_string(count));
    }
    return count;
}

std::string error_file(OptionWords& words) {
    std::string file = words.text();
    if (file.find_first_of("=:") != std::string::npos) {
        throw UsageError(
            "option -e: global definitions are not supported, only the name of a file for "
            "messages");
    }
    return file;
}

std::string date_line(const char* name, const std::tm& time) {
    std::array<char, 64> text{};
    std::strftime(text.data(), text.size(), "%Y:%m:%d %H:%M:%S", &time);
    return std::string(name) + "= " + text.data();
}

}  // namespace

bool parse_common_option(OptionWords& words, CommonOptions& options, RenderSettings& settings) {
    const std::string& word = words.option();
    if (word.empty() || word.front() != '-' || word == "-") {
        options.scene_positions.push_back(words.position());
        options.scene_files.push_back(word);
        words.skip(1);
    } else if (word == "-n") {
        options.workers = worker_count(words);
    } else if (word == "--executor") {
        options.executor = executor_kind(words.text());
    } else if (word == "--seed") {
        settings.light.seed = words.unsigned_integer();
    } else if (word == "--ambient-lights") {
        settings.light.ambient_lights = words.integer();
        if (settings.light.ambient_lights < 0)
            throw UsageError("option --ambient-lights: expected a number, 0 for all");
    } else if (word == "-e") {
        options.error_file = error_file(words);
    } else if (word == "--stats") {
        options.stats_file = words.text();
    } else if (word == "--quiet") {
        options.quiet = true;
        words.skip(1);
    } else if (word == "--allow-commands") {
        options.allow_commands = true;
        words.skip(1);
    } else if (word == "--stale") {
        options.stale_allowed = true;
        words.skip(1);
    } else {
        return parse_rank_option(words, options.ranks);
    }
    return true;
}

void refuse_option(const OptionWords& words, std::vector<std::string> names) {
    for (const std::string& name : common_option_names()) names.push_back(name);
    std::string message = "unknown option " + words.option();
    if (const std::optional<std::string> meant = nearest_name(words.option(), names)) {
        message += ", did you mean " + *meant + "?";
    }
    throw UsageError(message);
}

std::vector<std::string> common_option_names() {
    std::vector<std::string> names{
        "-n",        "-e",       "--executor",       "--seed",  "--ambient-lights",
        "--stats",   "--quiet",  "--allow-commands", "--stale", "--help",
        "--version", "-defaults"};
    for (std::string& name : rank_option_names()) names.push_back(std::move(name));
    return names;
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

std::vector<std::string> history_header(const std::vector<std::string>& scene_header,
                                        const std::string& command_line) {
    std::vector<std::string> lines;
    for (const std::string& line : scene_header) {
        if (!line.starts_with("#?")) lines.push_back(line);
    }
    lines.push_back(command_line);
    lines.emplace_back("SOFTWARE= Lightwalk " LIGHTWALK_VERSION);
    return lines;
}

std::vector<std::string> date_lines() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    std::tm universal{};
    localtime_r(&now, &local);
    gmtime_r(&now, &universal);
    return {date_line("CAPDATE", local), date_line("GMT", universal)};
}

}  // namespace lightwalk
