#include "apps/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace lightwalk {
namespace {

// A signal handler has no other way to reach its process.
StopFlag stop_flag;                                       // NOLINT
std::atomic<InterruptPhase> phase{InterruptPhase::leave};  // NOLINT
static_assert(std::atomic<InterruptPhase>::is_always_lock_free);

void on_interrupt(int /*signal*/) {
    const InterruptPhase now = phase.load();
    const bool again = now == InterruptPhase::request && stop_flag.requested();
    if (now == InterruptPhase::leave || again) _exit(kInterruptedStatus);
    stop_flag.request();
}

}  // namespace

void handle_interrupts() {
    struct sigaction action = {};
    action.sa_handler = on_interrupt;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
}

void set_interrupt_phase(InterruptPhase next) { phase.store(next); }
const StopFlag& interrupt_flag() { return stop_flag; }

}  // namespace lightwalk
