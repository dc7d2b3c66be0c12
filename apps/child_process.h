#pragma once
// A process that this one starts, waits for, and hands signals on to.
#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/file_descriptor.h"

namespace lightwalk {

/// SIGCHLD, SIGINT and SIGTERM, which are blocked while this lives: in this thread, and in those
/// that it starts meanwhile.
class ChildSignals {
  public:
    ChildSignals();
    ~ChildSignals();
    ChildSignals(const ChildSignals&) = delete;
    ChildSignals& operator=(const ChildSignals&) = delete;

    [[nodiscard]] const sigset_t& before() const { return before_; }  ///< what was blocked then
    [[nodiscard]] int descriptor() const { return descriptor_.get(); }

  private:
    sigset_t before_{};
    FileDescriptor descriptor_;
};

/// Tells of a process that hangs in its own end: all of its children have ended, and it takes no
/// notice. mpirun may do so (a lock between its threads, as PMIx's server ends).
class UnheededEnds {
  public:
    /// Whether it has been so for a while by now, at every call; false where the system does not
    /// say which children there are. To be called every second or so.
    [[nodiscard]] bool seen(pid_t process);

  private:
    std::optional<std::chrono::steady_clock::time_point> since_;
};

/// It gets SIGTERM where this process dies.
class ChildProcess {
  public:
    /// What becomes of its output while it runs.
    struct Output {
        /// Each line of standard output, without its end; false: it is for somebody else, and
        /// written to this process's. Null: the child writes there by itself.
        std::function<bool(std::string_view line)> take_line;
        /// Called every half second; null: never.
        std::function<void()> tick;
    };
    /// What has become of it.
    struct End {
        int how = 0;               ///< as waitpid(2) tells it
        bool interrupted = false;  ///< this process was told to end, and told it so
        bool hung = false;         ///< it was killed, see UnheededEnds
        std::string last_words;    ///< the end of what it has written to standard error
    };

    /// Throws std::system_error where its program cannot be started, InputError where there is no
    /// room for pipes.
    ChildProcess(std::vector<std::string> words, const ChildSignals& signals, Output output);

    /// Waits for its end.
    [[nodiscard]] End wait();
    void terminate() const { kill(process_, SIGTERM); }

  private:
    void take_signal(End& end) const;
    void take_output();
    void take_errors(End& end) const;

    const ChildSignals& signals_;
    Output output_;
    pid_t process_ = 0;
    UnheededEnds ends_;         ///< of its children
    FileDescriptor out_, err_;  ///< what it writes; none: it does so by itself
    std::string line_;          ///< the beginning of one
};

}  // namespace lightwalk
