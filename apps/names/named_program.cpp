#include "apps/names/named_program.h"

#include <algorithm>
#include <cstdio>
#include <new>

#include "apps/commands.h"
#include "core/error.h"
#include "core/math/function_ref.h"
#include "parallel/comm/communicator.h"

namespace lightwalk {
namespace {

/// A command that knows by itself how it is called.
template <int (*Run)(const std::vector<std::string>& words, Communicator* ranks)>
int run_as(const std::string& /*name*/, const std::vector<std::string>& words,
           Communicator* ranks) {
    return Run(words, ranks);
}

constexpr NamedProgram kPrograms[] = {
    {"oconv", run_oconv},
    {"rtrace", run_as<run_rtrace>, true},
    {"rpict", run_as<run_rpict>, true},
    {"rcontrib", run_as<run_rcontrib>, true},
    {"gensky", run_generator},
    {"gendaylit", run_generator},
    {"genbox", run_generator},
    {"xform", run_generator},
    {"getinfo", run_getinfo},
    {"vwrays", run_vwrays},
    {"replmarks", run_generator},
    {"pfilt", run_pfilt},
    {"pvalue", run_pvalue},
    {"evalglare", run_evalglare},
    {"falsecolor", run_falsecolor},
    {"gensurf", run_generator},
    {"genrev", run_generator},
    {"genworm", run_generator},
    {"genprism", run_generator},
    {"genblinds", run_generator},
};

}  // namespace

std::span<const NamedProgram> named_programs() {
    return kPrograms;
}

const NamedProgram* find_named_program(const std::string& path) {
    const std::string name = path.substr(path.rfind('/') + 1);
    const auto* const found = std::ranges::find_if(
        kPrograms, [&](const NamedProgram& program) { return name == program.name; });
    return found != std::end(kPrograms) ? found : nullptr;
}

std::string named_version() {
    // Of the Radiance whose behaviour this is, and the day from which on it is.
    return "RADIANCE 6.1a Lightwalk " LIGHTWALK_VERSION " 2026-11-29 (6.1.0)";
}

namespace {

/// See run_named_program().
int run_named(const std::string& name, const std::vector<std::string>& words, Communicator* ranks,
              FunctionRef<int()> run) {
    const auto say = [&](const std::string& what) {
        if (ranks != nullptr && ranks->rank() != 0) return;  // all see the same
        const bool named = what.starts_with(name + ':') || what.starts_with("usage:");
        std::fprintf(stderr, "%s%s\n", named ? "" : (name + ": fatal - ").c_str(), what.c_str());
    };
    try {
        if (!words.empty() && (words[0] == "-version" || words[0] == "--version")) {
            std::puts(named_version().c_str());
            return kSuccessStatus;
        }
        return run();
    } catch (const std::bad_alloc&) {
        say("out of memory");
    } catch (const std::exception& error) {
        say(printable(error.what()));
    }
    return kFailureStatus;
}

}  // namespace

int run_named_program(const NamedProgram& program, const std::vector<std::string>& words,
                      Communicator* ranks) {
    return run_named(program.name, words, ranks,
                     [&] { return program.run(program.name, words, ranks); });
}

int run_named_rtrace(const std::shared_ptr<const ResidentScene>& scene,
                     const std::vector<std::string>& words) {
    return run_named("rtrace", words, nullptr, [&] { return run_rtrace_on(scene, words); });
}

}  // namespace lightwalk
