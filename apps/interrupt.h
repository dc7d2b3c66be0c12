#pragma once
// Ctrl-C and SIGTERM: end cleanly, leaving nothing half-written.
#include <string>

#include "parallel/stop_flag.h"

namespace lightwalk {

inline constexpr int kInterruptedStatus = 130;  ///< what a shell reports for SIGINT

/// What these signals do now.
enum class InterruptPhase {
    leave,    ///< end the process at once: nothing has been written
    request,  ///< ask the workers to stop; after 0.7 s, or once more, ends the process
    finish,   ///< remember it, and let the output be completed
};

/// Install the handler, in phase `leave`.
void handle_interrupts();
void set_interrupt_phase(InterruptPhase phase);
[[nodiscard]] StopFlag& interrupt_flag();

/// A file that is removed when an interrupt ends the process at once; "": none (any more). At most
/// one; longer names than the system allows are not remembered.
void set_interrupt_litter(const std::string& path);

}  // namespace lightwalk
