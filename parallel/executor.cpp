#include "parallel/executor.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel/tbb_arena.h"

namespace lightwalk {
namespace {

class SerialExecutor final : public Executor {
  public:
    using Executor::for_each;
    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        for (std::size_t i = 0; i < count && !stop.requested(); ++i) task(i, 0);
    }
    [[nodiscard]] int concurrency() const override { return 1; }
};

/// One call of for_each. Workers take the next number until there is none, or until somebody ends
/// the job.
struct Job {
    Task task;
    std::size_t count;
    const StopFlag& stop;
    std::atomic<std::size_t> next{0};
    StopFlag failed;
    std::mutex error_mutex;
    std::exception_ptr error{};

    Job(Task t, std::size_t n, const StopFlag& s) : task(t), count(n), stop(s) {}

    void work(int worker) {
        try {
            while (!stop.requested() && !failed.requested()) {
                const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
                if (i >= count) return;
                task(i, worker);
            }
        } catch (...) {
            const std::lock_guard lock(error_mutex);
            if (!error) error = std::current_exception();
            failed.request();
        }
    }
};

/// std::threads that pull task numbers from one counter.
class ThreadPool final : public Executor {
  public:
    using Executor::for_each;

    explicit ThreadPool(int workers) {
        threads_.reserve(static_cast<std::size_t>(workers) - 1);
        try {
            for (int worker = 1; worker < workers; ++worker) {
                threads_.emplace_back([this, worker] { run_worker(worker); });
            }
        } catch (...) {  // no more threads to be had: those that run must end first
            shut_down();
            throw;
        }
    }
    ~ThreadPool() override { shut_down(); }
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        Job job(task, count, stop);
        {
            const std::lock_guard lock(mutex_);
            job_ = &job;
            ++generation_;
            busy_ = threads_.size();
        }
        begin_.notify_all();
        job.work(0);
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return busy_ == 0; });
        job_ = nullptr;
        if (job.error) std::rethrow_exception(job.error);
    }
    [[nodiscard]] int concurrency() const override { return static_cast<int>(threads_.size()) + 1; }

  private:
    void run_worker(int worker) {
        std::uint64_t served = 0;
        std::unique_lock lock(mutex_);
        for (;;) {
            begin_.wait(lock, [&] { return ending_ || generation_ != served; });
            if (ending_) return;
            served = generation_;
            Job& job = *job_;
            lock.unlock();
            job.work(worker);
            lock.lock();
            if (--busy_ == 0) done_.notify_one();
        }
    }

    void shut_down() {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        begin_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }

    std::mutex mutex_;
    std::condition_variable begin_, done_;
    Job* job_ = nullptr;            // guarded by mutex_, as all below
    std::uint64_t generation_ = 0;  ///< counts jobs
    std::size_t busy_ = 0;          ///< threads that have not finished this job
    bool ending_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int workers) {
    workers = std::max(workers, 1);
    switch (kind) {
        case ExecutorKind::serial:
            break;
        case ExecutorKind::threads:
            return std::make_unique<ThreadPool>(workers);
        case ExecutorKind::tbb:
            return make_tbb_arena(workers);
    }
    return std::make_unique<SerialExecutor>();
}

int hardware_threads() {
    // What glibc 2.36 tells std::thread::hardware_concurrency() does not know of taskset.
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
        return std::max(1, CPU_COUNT(&allowed));
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace lightwalk
