// lightwalk: one program, one command a task.
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "core/error.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

struct Command {
    const char* name;
    int (*run)(const std::vector<std::string>&);
};
constexpr Command kCommands[] = {{"render", run_render}, {"trace", run_trace}, {"info", run_info}};

/// --help, --version and their Radiance spellings, wherever they stand; nothing: none of them.
bool answer_questions(const std::string& command, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (word == "--help" || word == "-help") {
            std::fputs(help_text(command), stdout);
            return true;
        }
        if (word == "--version" || word == "-version") {
            std::puts("Lightwalk " LIGHTWALK_VERSION);
            return true;
        }
    }
    return false;
}

int dispatch(const std::vector<std::string>& words) {
    if (words.empty()) {
        std::fputs(help_text(""), stderr);
        return kUsageStatus;
    }
    const std::string& name = words.front();
    for (const Command& command : kCommands) {
        if (name != command.name) continue;
        const std::vector<std::string> rest(words.begin() + 1, words.end());
        return answer_questions(name, rest) ? kSuccessStatus : command.run(rest);
    }
    if (name == "help") {
        std::fputs(help_text(words.size() > 1 ? words[1] : ""), stdout);
        return kSuccessStatus;
    }
    if (answer_questions("", {name})) return kSuccessStatus;
    std::vector<std::string> names{"help"};
    for (const Command& command : kCommands) names.emplace_back(command.name);
    const std::optional<std::string> meant = nearest_name(name, names);
    throw UsageError("unknown command " + name + (meant ? ", did you mean " + *meant + "?" : ""));
}

/// How messages name the program: with its command, if there is such a command.
std::string program_name(const std::vector<std::string>& words) {
    for (const Command& command : kCommands) {
        if (!words.empty() && words.front() == command.name) return "lightwalk " + words.front();
    }
    return "lightwalk";
}

int run(const std::vector<std::string>& words) {
    const std::string program = program_name(words);
    try {
        return dispatch(words);
    } catch (const UsageError& error) {
        std::fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program.c_str(),
                     printable(error.what()).c_str(), program.c_str());
        return kUsageStatus;
    } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "%s: out of memory\n", program.c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program.c_str(), printable(error.what()).c_str());
    }
    return kFailureStatus;
}

}  // namespace
}  // namespace lightwalk

int main(int argc, char** argv) {
    return lightwalk::run(argc > 1 ? std::vector<std::string>(argv + 1, argv + argc)
                                   : std::vector<std::string>());
}
