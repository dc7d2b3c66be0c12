#pragma once
// What the threads of a rank ask of the machine: the time, and to wait for each other.
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/math/function_ref.h"

namespace lightwalk {

/// The machine's own. A simulation has another one, where one thread plays all ranks and time
/// passes only while nobody has anything to do.
class RankThreads {
  public:
    using Clock = std::chrono::steady_clock;
    using Lock = std::unique_lock<std::mutex>;

    RankThreads() = default;
    virtual ~RankThreads() = default;
    RankThreads(const RankThreads&) = delete;
    RankThreads& operator=(const RankThreads&) = delete;

    [[nodiscard]] virtual Clock::time_point now() { return Clock::now(); }
    /// Until notify(changed), or for no reason.
    virtual void wait(std::condition_variable& changed, Lock& lock) { changed.wait(lock); }
    /// The same, or until `most` has passed.
    virtual void wait_for(std::condition_variable& changed, Lock& lock, Clock::duration most) {
        changed.wait_for(lock, most);
    }
    /// All who wait for it go on.
    virtual void notify(std::condition_variable& changed) { changed.notify_all(); }
    /// Runs `beside`, which must not throw, on another thread while this one runs `here`; returns,
    /// or throws what `here` has thrown, when both are done.
    virtual void side_by_side(FunctionRef<void()> beside, FunctionRef<void()> here) {
        const std::jthread other(beside);
        here();
    }

    template <class Holds>
    void wait_until(std::condition_variable& changed, Lock& lock, Holds holds) {
        while (!holds()) wait(changed, lock);
    }
};

}  // namespace lightwalk
