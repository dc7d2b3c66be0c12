#include "apps/interrupt.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>

namespace lightwalk {
namespace {

// A signal handler has no other way to reach its process.
StopFlag stop_flag;                                        // NOLINT
std::atomic<InterruptPhase> phase{InterruptPhase::leave};  // NOLINT
static_assert(std::atomic<InterruptPhase>::is_always_lock_free);

std::array<char, 4096> litter{};      // NOLINT
std::atomic<bool> has_litter{false};  // NOLINT
static_assert(std::atomic<bool>::is_always_lock_free);

[[noreturn]] void leave() {
    if (has_litter.load()) (void)unlink(litter.data());
    _exit(kInterruptedStatus);
}

/// A worker may be deep in one pixel; as nothing has been written, the process need not wait for
/// it.
void on_patience_end(int /*signal*/) {
    if (phase.load() == InterruptPhase::request) leave();
}

void on_interrupt(int /*signal*/) {
    const InterruptPhase now = phase.load();
    const bool again = now == InterruptPhase::request && stop_flag.requested();
    if (now == InterruptPhase::leave || again) leave();
    stop_flag.request();
    itimerval patience{};
    patience.it_value.tv_usec = 700000;
    setitimer(ITIMER_REAL, &patience, nullptr);
}

void install(int signal, void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
}

}  // namespace

void handle_interrupts() {
    install(SIGALRM, on_patience_end);
    install(SIGINT, on_interrupt);
    install(SIGTERM, on_interrupt);  // what mpirun sends its processes
}

void set_interrupt_phase(InterruptPhase next) {
    phase.store(next);
}
StopFlag& interrupt_flag() {
    return stop_flag;
}

void set_interrupt_litter(const std::string& path) {
    has_litter.store(false);
    if (path.empty() || path.size() >= litter.size()) return;
    litter.fill(0);
    std::copy(path.begin(), path.end(), litter.begin());
    has_litter.store(true);
}

}  // namespace lightwalk
