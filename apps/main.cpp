// lightwalk: one program, one command a task.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "apps/commands.h"
#include "apps/names/named_program.h"
#include "apps/session/heap.h"
#include "apps/session/lightwalk/ranks.h"
#include "core/error.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

/// --help, --version and their Radiance spellings, wherever they stand; nothing: none of them.
bool answer_questions(const std::string& command, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (word == "--help" || word == "-help") {
            std::fputs(help_text(command).c_str(), stdout);
            return true;
        }
        if (word == "--version" || word == "-version") {
            std::puts("Lightwalk " LIGHTWALK_VERSION);
            return true;
        }
    }
    return false;
}

int dispatch(const std::vector<std::string>& words, Communicator* ranks) {
    if (words.empty()) {
        std::fputs(help_text("").c_str(), stderr);
        return kUsageStatus;
    }
    const std::string& name = words.front();
    if (const Command* const command = find_command(name)) {
        const std::vector<std::string> rest(words.begin() + 1, words.end());
        return answer_questions(name, rest) ? kSuccessStatus : command->run(rest, ranks);
    }
    if (name == "help" && words.size() > 1 && words[1] == "man") {
        std::fputs(manual_text(words.size() > 2 ? words[2] : "").c_str(), stdout);
        return kSuccessStatus;
    }
    if (name == "help") {
        std::fputs(help_text(words.size() > 1 ? words[1] : "").c_str(), stdout);
        return kSuccessStatus;
    }
    if (answer_questions("", {name})) return kSuccessStatus;
    std::vector<std::string> names{"help"};
    for (const Command& command : commands()) names.emplace_back(command.name);
    const std::optional<std::string> meant = nearest_name(name, names);
    throw UsageError("unknown command " + name + (meant ? ", did you mean " + *meant + "?" : ""));
}

/// Runs what the process is called by: a program of Radiance's. Sets `ranks` where there are
/// several.
int run_by_name(const NamedProgram& program, const std::vector<std::string>& words,
                std::unique_ptr<Communicator>& ranks) {
    try {
        if (started_by_mpi()) ranks = open_mpi();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: fatal - %s\n", program.name, error.what());
        return kFailureStatus;
    }
    if (ranks && ranks->rank() != 0 && !program.shared) return kSuccessStatus;
    return run_named_program(program, words, ranks.get());
}

/// Runs the command; what is wrong is said on standard error, by rank 0 alone where all ranks see
/// it. Sets `ranks` where there are several.
int run(const std::vector<std::string>& words, std::unique_ptr<Communicator>& ranks) {
    const Command* const command = words.empty() ? nullptr : find_command(words.front());
    const std::string program = std::string("lightwalk") + (command ? ' ' + words.front() : "");
    const auto say = [&](const std::string& text) {
        if (!ranks || ranks->rank() == 0) std::fprintf(stderr, "%s\n", text.c_str());
    };
    try {
        if (started_by_mpi()) ranks = open_mpi();
        const bool shared = command != nullptr && command->shared;
        if (ranks && ranks->rank() != 0 && !shared) return kSuccessStatus;
        return dispatch(words, ranks.get());
    } catch (const UsageError& error) {
        say(program + ": " + printable(error.what()) + "\nTry '" + program + " --help'.");
        return kUsageStatus;
    } catch (const InputError& error) {
        say(error.what());
    } catch (const std::bad_alloc&) {
        say(program + ": out of memory");
    } catch (const std::exception& error) {
        say(program + ": " + printable(error.what()));
    }
    return kFailureStatus;
}

}  // namespace
}  // namespace lightwalk

int main(int argc, char** argv) {
    lightwalk::prepare_heap();
    std::unique_ptr<lightwalk::Communicator> ranks;
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const lightwalk::NamedProgram* const named =
        argc > 0 ? lightwalk::find_named_program(argv[0]) : nullptr;
    const int status = named != nullptr ? lightwalk::run_by_name(*named, words, ranks)
                                        : lightwalk::run(words, ranks);
    if (!ranks || status == lightwalk::kSuccessStatus) return status;
    // Of a process that ends by itself with another status mpirun tells a dozen lines: rank 0 ends
    // all. The others wait for that outside of MPI: mpirun may hang or crash where processes are
    // killed that are about to end.
    constexpr std::chrono::milliseconds kShort{100}, kLong{20000};
    std::this_thread::sleep_for(ranks->rank() == 0 ? kShort : kLong);
    if (ranks->rank() == 0) {
        std::fflush(nullptr);
        ranks->abort(status);
    }
    ranks.reset();
    return status;
}
