#include "parallel/executor.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace lightwalk;

namespace {

struct Kind {
    ExecutorKind kind;
    int workers;
};
const std::vector<Kind> kKinds{{ExecutorKind::serial, 1},
                               {ExecutorKind::threads, 1},
                               {ExecutorKind::threads, 7},
                               {kDefaultExecutor, 1},
                               {kDefaultExecutor, 7}};

}  // namespace

TEST_CASE("every executor runs each task exactly once, on a worker that exists") {
    for (const Kind& k : kKinds) {
        CAPTURE(static_cast<int>(k.kind));
        const std::unique_ptr<Executor> executor = make_executor(k.kind, k.workers);
        CHECK(executor->concurrency() == (k.kind == ExecutorKind::serial ? 1 : k.workers));
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
            std::vector<std::atomic<int>> runs(count);
            std::atomic<bool> workers_exist{true};
            executor->for_each(count, [&](std::size_t i, int worker) {
                ++runs[i];
                if (worker < 0 || worker >= executor->concurrency()) workers_exist = false;
            });
            CHECK(workers_exist);
            CHECK(std::all_of(runs.begin(), runs.end(),
                              [](const std::atomic<int>& n) { return n == 1; }));
        }
    }
}

TEST_CASE("no two tasks run with the same worker at the same time") {
    for (const Kind& k : kKinds) {
        CAPTURE(static_cast<int>(k.kind));
        const std::unique_ptr<Executor> executor = make_executor(k.kind, k.workers);
        std::vector<std::atomic<int>> inside(static_cast<std::size_t>(k.workers));
        std::atomic<bool> alone{true};
        executor->for_each(200, [&](std::size_t, int worker) {
            std::atomic<int>& mine = inside[static_cast<std::size_t>(worker)];
            if (++mine != 1) alone = false;
            std::this_thread::yield();
            --mine;
        });
        CHECK(alone);
    }
}

TEST_CASE("the serial executor keeps the order of tasks") {
    std::vector<std::size_t> order;
    make_executor(ExecutorKind::serial, 5)->for_each(4, [&](std::size_t i, int) {
        order.push_back(i);
    });
    CHECK(order == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE(
    "an exception in a task comes out of for_each, ends the rest, and leaves the executor usable") {
    for (const Kind& k : kKinds) {
        CAPTURE(static_cast<int>(k.kind));
        const std::unique_ptr<Executor> executor = make_executor(k.kind, k.workers);
        std::atomic<int> started{0};
        std::string message;
        try {
            executor->for_each(1000000, [&](std::size_t i, int) {
                ++started;
                if (i == 10) throw std::runtime_error("task 10");
            });
        } catch (const std::runtime_error& error) {
            message = error.what();
        }
        CHECK(message == "task 10");
        CHECK(started < 1000000);
        std::atomic<int> after{0};
        executor->for_each(50, [&](std::size_t, int) { ++after; });
        CHECK(after == 50);
    }
}

TEST_CASE("no task starts once a stop is requested") {
    for (const Kind& k : kKinds) {
        CAPTURE(static_cast<int>(k.kind));
        const std::unique_ptr<Executor> executor = make_executor(k.kind, k.workers);
        StopFlag stop;
        std::atomic<int> started{0}, late{0};
        std::atomic<bool> requested{false};
        executor->for_each(
            1000000,
            [&](std::size_t, int) {
                if (requested) ++late;
                if (++started != 20) return;
                stop.request();
                requested = true;
            },
            stop);
        CHECK(started >= 20);
        CHECK(started < 1000000);
        CHECK(late <= k.workers);  // each may have looked just before the request
        stop.clear();
        CHECK_FALSE(stop.requested());
    }
}

TEST_CASE("several threads really work on tasks that wait for each other") {
    for (const ExecutorKind kind : {ExecutorKind::threads}) {  // TBB does not promise threads
        const std::unique_ptr<Executor> executor = make_executor(kind, 3);
        std::atomic<int> arrived{0};
        executor->for_each(3, [&](std::size_t, int) {
            ++arrived;
            while (arrived < 3) std::this_thread::yield();
        });
        CHECK(arrived == 3);
    }
}
