#pragma once
// The program by the names of Radiance's programs: "lightwalk install-names" makes links to it, and
// it acts by the name that it is called by.
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lightwalk {

class Communicator;
class ResidentScene;

struct NamedProgram {
    const char* name;
    /// As Command::run; `name` is this program's.
    int (*run)(const std::string& name, const std::vector<std::string>& words, Communicator* ranks);
    bool shared = false;  ///< ranks share its work; else rank 0 does it alone
};
[[nodiscard]] std::span<const NamedProgram> named_programs();
/// By the path that a process was started with; null: it is none of them.
[[nodiscard]] const NamedProgram* find_named_program(const std::string& path);

/// What they answer to -version. Programs that drive Radiance look for "RADIANCE", the day and the
/// numbers in parentheses.
[[nodiscard]] std::string named_version();

/// Runs it, and says on standard error what is wrong, after the program's name. Returns the exit
/// status: 1 for every mistake, as Radiance's programs do.
int run_named_program(const NamedProgram& program, const std::vector<std::string>& words,
                      Communicator* ranks);
/// The same of rtrace, with a scene that is there already (run_rtrace_on()).
int run_named_rtrace(const std::shared_ptr<const ResidentScene>& scene,
                     const std::vector<std::string>& words);

// What the programs do; see NamedProgram::run.
int run_generator(const std::string& name, const std::vector<std::string>& words,
                  Communicator* ranks);
int run_oconv(const std::string& name, const std::vector<std::string>& words, Communicator* ranks);
int run_getinfo(const std::string& name, const std::vector<std::string>& words,
                Communicator* ranks);
int run_vwrays(const std::string& name, const std::vector<std::string>& words, Communicator* ranks);
int run_pvalue(const std::string& name, const std::vector<std::string>& words, Communicator* ranks);
int run_pfilt(const std::string& name, const std::vector<std::string>& words, Communicator* ranks);
int run_falsecolor(const std::string& name, const std::vector<std::string>& words,
                   Communicator* ranks);
int run_evalglare(const std::string& name, const std::vector<std::string>& words,
                  Communicator* ranks);

}  // namespace lightwalk
