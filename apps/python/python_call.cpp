#include "apps/python/python_call.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <thread>

namespace py = pybind11;

namespace lightwalk {
namespace {

constexpr std::chrono::milliseconds kTick{50};

/// Work that another thread does.
class BackgroundWork {
  public:
    explicit BackgroundWork(FunctionRef<void()> work)
        : thread_([this, work] {
              std::exception_ptr problem;
              try {
                  work();
              } catch (...) {
                  problem = std::current_exception();
              }
              const std::lock_guard lock(mutex_);
              problem_ = problem;
              ended_ = true;
              changed_.notify_all();
          }) {}

    /// True: it has ended.
    bool wait() {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, kTick, [this] { return ended_; });
    }
    /// After wait() has said so.
    [[nodiscard]] std::exception_ptr join() {
        thread_.join();
        return problem_;
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool ended_ = false;
    std::exception_ptr problem_;
    std::thread thread_;  // uses those above
};

}  // namespace

void wait_for(FunctionRef<void()> work, FunctionRef<void()> cancel, FunctionRef<void()> tick) {
    BackgroundWork background(work);
    std::exception_ptr raised;
    const auto look = [&] {
        const py::gil_scoped_acquire lock;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            tick();
        } catch (...) {
            raised = std::current_exception();
            cancel();
        }
    };
    std::exception_ptr problem;
    {
        const py::gil_scoped_release unlocked;
        while (!background.wait())
            if (!raised) look();
        problem = background.join();
    }
    if (raised) std::rethrow_exception(raised);
    if (problem) std::rethrow_exception(problem);
}

TakeProgressReport ProgressTeller::taker() {
    if (listener_.is_none()) return {};
    return [this](const RenderProgress& progress) {
        const std::lock_guard lock(mutex_);
        newest_ = progress;
    };
}

void ProgressTeller::tell() {
    if (listener_.is_none()) return;
    std::optional<RenderProgress> progress;
    {
        const std::lock_guard lock(mutex_);
        progress.swap(newest_);
    }
    if (progress)
        listener_(progress->done, progress->rays, progress->seconds, progress->seconds_left);
}

}  // namespace lightwalk
