#include "tests/apps/program.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "apps/child_process.h"

namespace lightwalk::test {
namespace {

std::array<int, 2> make_pipe() {
    std::array<int, 2> ends{};
    REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
    return ends;
}

std::string read_all(int descriptor) {
    std::string text;
    std::array<char, 65536> buffer{};
    for (ssize_t count = 0; (count = read(descriptor, buffer.data(), buffer.size())) > 0;) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return text;
}

/// What waitpid(2) tells of it; what hangs in its own end is killed.
int wait_for_launcher(pid_t process, bool& hung) {
    int status = 0;
    for (UnheededEnds ends; waitpid(process, &status, WNOHANG) == 0;) {
        if (!hung && ends.seen(process)) hung = kill(process, SIGKILL) == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return status;
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& words,
                               const std::vector<std::string>& launcher)
    : launched_(!launcher.empty()) {
    std::signal(SIGPIPE, SIG_IGN);
    const std::array<int, 2> in = make_pipe();
    const std::array<int, 2> out = make_pipe();
    const std::array<int, 2> err = make_pipe();
    std::vector<std::string> line = launcher;
    line.emplace_back(LIGHTWALK_PROGRAM);
    line.insert(line.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    arguments.reserve(line.size() + 1);
    for (std::string& word : line) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    process_ = fork();
    REQUIRE(process_ >= 0);
    if (process_ == 0) {
        dup2(in[0], STDIN_FILENO);
        dup2(out[1], STDOUT_FILENO);
        dup2(err[1], STDERR_FILENO);
        execvp(arguments.front(), arguments.data());
        _exit(127);
    }
    for (const int unused : {in[0], out[1], err[1]}) close(unused);
    in_ = in[1];
    out_ = out[0];
    err_ = err[0];
}

RunningProgram::~RunningProgram() {
    if (process_ >= 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    end_input();
    close(out_);
    close(err_);
}

void RunningProgram::send(const std::string& input) const {
    for (std::size_t at = 0; at < input.size();) {
        const ssize_t count = write(in_, input.data() + at, input.size() - at);
        if (count <= 0) return;  // it no longer listens
        at += static_cast<std::size_t>(count);
    }
}

std::string RunningProgram::receive(std::size_t bytes) const {
    std::string text;
    while (text.size() < bytes) {
        pollfd ready{out_, POLLIN, 0};
        if (poll(&ready, 1, 10000) <= 0) break;
        std::array<char, 4096> buffer{};
        const ssize_t count =
            read(out_, buffer.data(), std::min(buffer.size(), bytes - text.size()));
        if (count <= 0) break;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return text;
}

void RunningProgram::end_input() {
    if (in_ >= 0) close(in_);
    in_ = -1;
}

void RunningProgram::interrupt() const {
    kill(process_, SIGINT);
}

ProgramResult RunningProgram::finish(const std::string& input) {
    std::thread inputs([&] {
        send(input);
        end_input();
    });
    ProgramResult result;
    std::thread errors([&] { result.err = read_all(err_); });
    std::thread outputs([&] { result.out = read_all(out_); });
    int status = 0;
    if (launched_)
        status = wait_for_launcher(process_, result.hung);
    else
        waitpid(process_, &status, 0);
    process_ = -1;
    outputs.join();
    errors.join();
    inputs.join();
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

bool launcher_died(const ProgramResult& result) {
    const auto says = [&](const char* words) {
        return result.err.find(words) != std::string::npos;
    };
    if (result.status == 128 + SIGSEGV) return says("orte_iof_hnp");
    return result.hung || (result.status != 0 && (says("ORTE_ERROR_LOG") ||
                                                  says("orte_init failed") || says("PMIX ERROR")));
}

ProgramResult run_program(const std::vector<std::string>& words, const std::string& input,
                          const std::vector<std::string>& launcher) {
    constexpr int kTries = 3;
    for (int tries = 1;; ++tries) {
        ProgramResult result = RunningProgram(words, launcher).finish(input);
        // The latter may crash where threads end while it looks for leaks, after the program's end.
        const bool tool_died =
            (!launcher.empty() && launcher_died(result)) ||
            result.err.find("LeakSanitizer has encountered a fatal error") != std::string::npos;
        if (!tool_died || tries == kTries) return result;
        MESSAGE("mpirun or the leak checker itself died; once more: ", result.err);
    }
}

std::optional<std::vector<std::string>> mpirun(int ranks, const std::vector<std::string>& more) {
#if defined(__SANITIZE_THREAD__)
    return std::nullopt;  // it takes what MPI does for races
#endif
    if (std::system("command -v mpirun > /dev/null") != 0) return std::nullopt;
    // Several at once in one folder for their sockets may take each other's away as they end
    // (open-mpi/ompi issue 8510).
    static const TemporaryFolder sockets;
    // Root must say that it means it; a killed rank may hold a lock of the memory that PMIx shares
    // with mpirun, which waits for it for ever; what MPI leaves behind at its end is not ours.
    std::vector<std::string> line{"env",
                                  "OMPI_ALLOW_RUN_AS_ROOT=1",
                                  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                                  "PMIX_MCA_gds=hash",
                                  "ASAN_OPTIONS=detect_leaks=0:handle_sigill=1",
                                  "mpirun",
                                  "--oversubscribe",
                                  "--bind-to",
                                  "none",
                                  "--mca",
                                  "orte_tmpdir_base",
                                  sockets.path(),
                                  "-n",
                                  std::to_string(ranks)};
    line.insert(line.end(), more.begin(), more.end());
    return line;
}

std::string read_whole(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();  // of what goes away meanwhile, as a process's files do, no exception
    return all.str();
}

double figure(const std::string& file, const std::string& pointer) {
    const auto all = nlohmann::json::parse(read_whole(file));
    const auto& found = all.at(nlohmann::json::json_pointer(pointer));
    return found.is_number() ? found.get<double>() : static_cast<double>(found.size());
}

}  // namespace lightwalk::test

TEST_CASE(
    "program: help and version answer on standard output with status 0, nothing at all with status "
    "2") {
    using lightwalk::test::run_program;
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                  {"render", "--help"},
                                                  {"trace", "-help"},
                                                  {"info", "--help"},
                                                  {"help", "trace"}}) {
        const auto result = run_program(words);
        CHECK(result.status == 0);
        CHECK(result.out.starts_with("lightwalk"));
        CHECK(result.err.empty());
    }
    CHECK(run_program({"--version"}).out.starts_with("Lightwalk "));
    const auto nothing = run_program({});
    CHECK(nothing.status == 2);
    CHECK(nothing.out.empty());
    const auto unknown = run_program({"rendre"});
    CHECK(unknown.status == 2);
    CHECK(unknown.err.find("did you mean render?") != std::string::npos);
}
