#pragma once
// Runs the built program as a user would.
#include <optional>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwalk::test {

struct ProgramResult {
    int status = -1;  ///< exit status; 128 + n for a process that signal n ended
    std::string out, err;
};

/// Run the program to its end with `input` on standard input.
ProgramResult run_program(const std::vector<std::string>& words, const std::string& input = "",
                          const std::vector<std::string>& launcher = {});

/// The program while it runs.
class RunningProgram {
  public:
    /// @param launcher  the command that starts it, before its own name: mpirun(...)
    explicit RunningProgram(const std::vector<std::string>& words,
                            const std::vector<std::string>& launcher = {});
    ~RunningProgram();  ///< kills it
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    [[nodiscard]] int process() const { return process_; }
    void send(const std::string& input) const;
    /// Read `bytes` of standard output; fewer when it ends or says nothing for ten seconds.
    [[nodiscard]] std::string receive(std::size_t bytes) const;
    void end_input();
    void interrupt() const;
    /// All that is left of its output, and its exit status, after more input of any size.
    ProgramResult finish(const std::string& input = "");

  private:
    int process_ = -1, in_ = -1, out_ = -1, err_ = -1;
};

/// Whether it was not the program that failed: Open MPI 4's mpirun itself may die while it passes
/// input on (open-mpi/ompi issue 7483).
[[nodiscard]] bool launcher_died(const ProgramResult& result);

/// The command that starts ranks of the program on this machine, however many cores it has; nothing
/// where there is none, or where the sanitizer cannot stand it.
[[nodiscard]] std::optional<std::vector<std::string>> mpirun(
    int ranks, const std::vector<std::string>& more = {});

[[nodiscard]] std::string read_whole(const std::string& path);

}  // namespace lightwalk::test
