#include "tests/simulation/world.h"

#include <cxxabi.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace lightwalk::simulation {
namespace {

/// From when a thread could go on to when it does.
constexpr Time kWakeUp = std::chrono::microseconds(200);

/// The list of exceptions of this real thread for that of a fiber: a fiber that waits within a
/// handler must not leave its exception to the next one. Both known runtimes have a pointer and a
/// number there.
void swap_exceptions(std::uint64_t (&own)[2]) {
    std::uint64_t theirs[2];
    void* const globals = __cxxabiv1::__cxa_get_globals();
    std::memcpy(theirs, globals, sizeof theirs);
    std::memcpy(globals, own, sizeof own);
    std::memcpy(own, theirs, sizeof own);
}

}  // namespace

World::World(Fibers& fibers, int ranks, std::uint64_t seed)
    : fibers_(fibers), chance_(seed), processes_(static_cast<std::size_t>(ranks)) {}

bool World::run(Time limit) {
    while (anybody() && !events_.empty() && events_.front().time <= limit) take_event();
    if (!anybody()) return true;
    for (int rank = 0; rank < ranks(); ++rank) kill(rank);
    while (anybody() && !events_.empty()) take_event();
    if (anybody()) throw std::logic_error("a simulated thread does not end");
    return false;
}

void World::at(Time when, std::function<void()> act) {
    events_.push_back({std::max(when, now_), chance_.number(), std::move(act)});
    std::push_heap(events_.begin(), events_.end());
}

void World::take_event() {
    std::pop_heap(events_.begin(), events_.end());
    const Event event = std::move(events_.back());
    events_.pop_back();
    now_ = event.time;
    event.act();
}

void World::start(int rank, std::function<void()> work) {
    std::size_t number = 0;
    while (number < all_.size() && all_[number]->alive) ++number;
    if (number == all_.size()) all_.push_back(std::make_unique<Thread>());
    if (number >= fibers_.size() || !fibers_.prepare(number))
        throw std::logic_error("too many simulated threads");
    Thread& thread = *all_[number];
    const std::uint64_t turn = thread.turn + 1;
    thread = {rank, true, false, true, nullptr, turn, std::move(work), {}};
    ++process(rank).threads;
    ++threads_;
    resume_at(now_ + chance_.up_to(kWakeUp), number, turn);
}

void World::kill(int rank) {
    Process& own = process(rank);
    if (own.threads == 0 || own.killed) return;
    own.killed = true;
    for (std::size_t i = 0; i < all_.size(); ++i)
        if (all_[i]->alive && all_[i]->rank == rank) resume_at(now_, i, all_[i]->turn);
}

void World::stop(int rank, Time until) {
    process(rank).stopped_until = std::max(process(rank).stopped_until, until);
}

void World::resume_at(Time when, std::size_t thread, std::uint64_t turn) {
    at(when, [this, thread, turn] {
        const Thread& own = *all_[thread];
        if (!own.waits || own.turn != turn) return;
        const Process& of = process(own.rank);
        if (of.stopped_until > now_ && !of.killed)
            resume_at(of.stopped_until, thread, turn);
        else
            resume(thread);
    });
}

void World::resume(std::size_t number) {
    Thread& thread = *all_[number];
    thread.waits = false;
    ++thread.turn;
    running_ = number;
    swap_exceptions(thread.exceptions);
    const bool over = thread.started ? fibers_.resume(number)
                                     : (thread.started = true, fibers_.start(number, thread.work));
    swap_exceptions(thread.exceptions);
    if (!over) return;
    thread.alive = false;
    --process(thread.rank).threads;
    --threads_;
}

void World::suspend(const void* on, Time until) {
    Thread& thread = *all_[running_];
    thread.on = on;
    thread.waits = true;
    if (until > Time(0)) resume_at(until, running_, thread.turn);
    fibers_.wait();
}

void World::wait(const void* on, Time until) {
    const int rank = all_[running_]->rank;
    if (!killed(rank)) suspend(on, until);
    if (killed(rank)) throw Killed();
}

void World::wake(const void* on) {
    for (std::size_t i = 0; i < all_.size(); ++i) {
        if (all_[i]->waits && all_[i]->on == on)
            resume_at(now_ + chance_.up_to(kWakeUp), i, all_[i]->turn);
    }
}

void World::side_by_side(FunctionRef<void()> beside, FunctionRef<void()> here) {
    bool over = false;
    start(all_[running_]->rank, [&] {
        try {
            beside();
        } catch (const Killed&) {
        }
        over = true;
        wake(&over);
    });
    const auto join = [&] {
        while (!over) suspend(&over, {});
    };
    try {
        here();
    } catch (...) {
        join();
        throw;
    }
    join();
}

}  // namespace lightwalk::simulation
