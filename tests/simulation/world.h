#pragma once
// Ranks whose threads are fibers of one thread, on a virtual clock: what they do, and in which
// order, follows from a seed alone.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/batch/fibers.h"
#include "parallel/ranks/rank_threads.h"

namespace lightwalk::simulation {

using Time = std::chrono::nanoseconds;  ///< since the world began
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Thrown out of whatever a fiber waits in when its rank is no more: no handler of errors sees it.
struct Killed {};

/// Random numbers that are the same with every standard library.
class Chance {
  public:
    explicit Chance(std::uint64_t seed) : random_(seed) {}
    /// 0 ... count - 1.
    [[nodiscard]] int below(int count) {
        return static_cast<int>(random_() % static_cast<std::uint64_t>(count));
    }
    [[nodiscard]] bool percent(int share) { return below(100) < share; }
    /// Uniform in 0 ... most.
    [[nodiscard]] Time up_to(Time most) {
        return Time(
            static_cast<Time::rep>(random_() % static_cast<std::uint64_t>(most.count() + 1)));
    }
    [[nodiscard]] std::uint64_t number() { return random_(); }

  private:
    std::mt19937_64 random_;
};

/// Clock, threads, and the state of each rank's process.
class World {
  public:
    /// A machine may wake who waits for a time so much later: fewer looks at nothing.
    static constexpr Time kCoarse = milliseconds(250);

    /// @param fibers  are used again by the next world: their stacks cost more than a run
    World(Fibers& fibers, int ranks, std::uint64_t seed);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    /// Until nobody lives or `limit` is reached; whoever lives then is killed. False: it was.
    [[nodiscard]] bool run(Time limit);

    [[nodiscard]] Time now() const { return now_; }
    [[nodiscard]] Chance& chance() { return chance_; }
    [[nodiscard]] int ranks() const { return static_cast<int>(processes_.size()); }
    /// Whether a thread of the rank has not returned.
    [[nodiscard]] bool lives(int rank) const { return process(rank).threads > 0; }
    [[nodiscard]] bool killed(int rank) const { return process(rank).killed; }
    [[nodiscard]] bool anybody() const { return threads_ > 0; }

    void at(Time when, std::function<void()> act);
    /// A thread of the rank.
    void start(int rank, std::function<void()> work);
    /// Ends a rank's process. Its threads end where they wait.
    void kill(int rank);
    /// The process does not run before that time, whatever comes.
    void stop(int rank, Time until);

    // Called by fibers.

    /// Until wake(on), or, where it is not 0, `until`.
    void wait(const void* on, Time until = {});
    void sleep(Time time) { wait(nullptr, now_ + time); }
    void wake(const void* on);
    /// Returns, or throws what `here` throws, when both are done.
    void side_by_side(FunctionRef<void()> beside, FunctionRef<void()> here);

  private:
    struct Process {
        bool killed = false;
        Time stopped_until{};
        int threads = 0;
    };
    struct Thread {
        int rank = 0;
        bool alive = false, started = false, waits = false;
        const void* on = nullptr;
        std::uint64_t turn = 0;  ///< of waiting: who wakes it for an older one is too late
        std::function<void()> work;
        /// The exceptions that it is handling (the C++ runtime has a list for each real thread).
        std::uint64_t exceptions[2] = {};
    };
    struct Event {
        Time time;
        std::uint64_t order;  ///< random among those of one time
        std::function<void()> act;
        bool operator<(const Event& other) const {
            return time != other.time ? time > other.time : order > other.order;
        }
    };
    [[nodiscard]] Process& process(int rank) { return processes_[static_cast<std::size_t>(rank)]; }
    [[nodiscard]] const Process& process(int rank) const {
        return processes_[static_cast<std::size_t>(rank)];
    }
    void take_event();
    void resume_at(Time when, std::size_t thread, std::uint64_t turn);
    void resume(std::size_t number);
    void suspend(const void* on, Time until);

    Fibers& fibers_;
    Chance chance_;
    Time now_{};
    std::vector<Process> processes_;
    std::vector<std::unique_ptr<Thread>> all_;  ///< by fiber
    std::vector<Event> events_;                 ///< a heap
    std::size_t running_ = 0;
    int threads_ = 0;
};

/// What one rank's threads ask of the world.
class WorldThreads final : public RankThreads {
  public:
    explicit WorldThreads(World& world) : world_(world) {}
    [[nodiscard]] Clock::time_point now() override { return Clock::time_point(world_.now()); }
    void wait(std::condition_variable& changed, Lock& lock) override {
        wait_unlocked(changed, lock, {});
    }
    void wait_for(std::condition_variable& changed, Lock& lock, Clock::duration most) override {
        wait_unlocked(changed, lock, world_.now() + std::max<Time>(most, World::kCoarse));
    }
    void notify(std::condition_variable& changed) override { world_.wake(&changed); }
    void side_by_side(FunctionRef<void()> beside, FunctionRef<void()> here) override {
        world_.side_by_side(beside, here);
    }

  private:
    void wait_unlocked(std::condition_variable& changed, Lock& lock, Time until) {
        struct Unlocked {
            Lock& lock;
            explicit Unlocked(Lock& held) : lock(held) { lock.unlock(); }
            ~Unlocked() { lock.lock(); }
        } const unlocked(lock);
        world_.wait(&changed, until);
    }
    World& world_;
};

}  // namespace lightwalk::simulation
