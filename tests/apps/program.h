#pragma once
// Runs the built program as a process.
#include <optional>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwalk::test {

struct ProgramResult {
    int status = -1;  ///< exit status; 128 + n for a process that signal n killed
    std::string out, err;
    bool hung = false;  ///< its launcher hung when what it had started had ended, and was killed
};

/// Run the program to its end with `input` on standard input.
ProgramResult run_program(const std::vector<std::string>& words, const std::string& input = "",
                          const std::vector<std::string>& launcher = {});

/// The program as a running process.
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
    /// Read `bytes` bytes of standard output; fewer when it ends, or writes nothing for ten
    /// seconds.
    [[nodiscard]] std::string receive(std::size_t bytes) const;
    void end_input();
    void interrupt() const;
    /// Write `input` (of any size), and return the rest of the output and the exit status.
    ProgramResult finish(const std::string& input = "");

  private:
    int process_ = -1, in_ = -1, out_ = -1, err_ = -1;
    bool launched_;  ///< by a launcher
};

/// Whether mpirun failed rather than the program: Open MPI 4's mpirun may crash while it forwards
/// input (open-mpi/ompi issue 7483), find no way to start, or hang in its end.
[[nodiscard]] bool launcher_died(const ProgramResult& result);

/// The command that starts ranks of the program on this machine, for any number of cores; nothing
/// without Open MPI, or under a sanitizer that it does not work with.
[[nodiscard]] std::optional<std::vector<std::string>> mpirun(
    int ranks, const std::vector<std::string>& more = {});

[[nodiscard]] std::string read_whole(const std::string& path);

/// What stands in a file of JSON at a pointer (RFC 6901), e.g. "/ambient/computed": a number, or
/// how many elements there are. Throws where nothing does.
[[nodiscard]] double figure(const std::string& file, const std::string& pointer);

}  // namespace lightwalk::test
