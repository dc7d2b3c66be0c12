#include "parallel/ambient_rounds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "parallel/cache_prepass.h"
#include "parallel/concurrent_cache.h"
#include "tests/parallel/ambient_values.h"
#include "tests/parallel/meeting.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A cache that knows whether it changes while tasks run.
class WatchedCache final : public AmbientCache {
  public:
    explicit WatchedCache(AmbientCache& cache) : cache_(cache) {}
    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override {
        ++(at_work ? while_at_work : between);
        cache_.insert(record);
    }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }
    bool at_work = false;
    int while_at_work = 0, between = 0;

  private:
    AmbientCache& cache_;
};

/// An executor that says when it is at work.
class WatchedExecutor final : public Executor {
  public:
    WatchedExecutor(Executor& executor, bool& at_work) : executor_(executor), at_work_(at_work) {}
    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        at_work_ = true;
        executor_.for_each(count, task, stop);
        at_work_ = false;
    }
    using Executor::for_each;
    [[nodiscard]] int concurrency() const override { return executor_.concurrency(); }

  private:
    Executor& executor_;
    bool& at_work_;
};

/// One process: a scene with a cache and workers of its own.
struct Process {
    Process(int bounces, int workers)
        : scene(kAmbientRoom, ambient_options(bounces, 0.3, 16)),
          shared(ambient_limits(scene.scene.cube().origin, scene.scene.cube().size, 0.3, 16)),
          watched(shared),
          cache(watched),
          pool(make_executor(ExecutorKind::threads, workers)),
          executor(*pool, watched.at_work),
          contexts(scene.tracer, scene.warnings, workers) {
        scene.tracer.use_ambient_cache(&cache);
        options.width = 40;
        options.height = 30;
        options.pixels.spacing = 1;
    }
    CachePrepassResult play(Group* exchange = nullptr, CheckpointSink* checkpoint = nullptr) {
        return fill_ambient_cache(
            scene.tracer, camera, options, CachePrepass::deterministic, cache, executor, contexts,
            stop, [&](const FrameProgress&) { told(); }, exchange, checkpoint);
    }
    std::vector<Rgb> picture() {
        return render_frame(scene.tracer, camera, options, executor, contexts, stop,
                            [](const FrameProgress&) {})
            .radiance;
    }
    void look() { (void)picture(); }

    TestScene scene;
    ConcurrentCache shared;
    WatchedCache watched;
    PublishedCache cache;
    std::unique_ptr<Executor> pool;
    WatchedExecutor executor;
    WorkerContexts contexts;
    Camera camera = ambient_eye();
    FrameOptions options;
    StopFlag stop;
    std::function<void()> told = [] {};
};

/// Keeps the steps of rounds.
struct KeptSteps final : CheckpointSink {
    [[nodiscard]] std::vector<BlockPixels> known() override { return {}; }
    void keep(const BlockPixels& /*pixels*/) override {}
    [[nodiscard]] std::vector<std::string> known_steps(const std::string& began) override {
        if (began == beginning) return steps;
        beginning = began;
        steps.clear();
        return {};
    }
    void keep_step(std::string step) override { steps.push_back(std::move(step)); }
    std::string beginning;
    std::vector<std::string> steps;
};

/// Workers, and a listener, that fill their caches together.
struct Together {
    /// @param checkpoint  of the last one
    Together(int bounces, int workers, int listeners, CheckpointSink* checkpoint)
        : shares(static_cast<std::size_t>(workers + listeners)) {
        const int count = workers + listeners;
        Meeting meeting(count);
        for (int i = 0; i < count; ++i)
            processes.push_back(std::make_unique<Process>(bounces, i == 0 ? 2 : 1));
        std::vector<std::thread> threads;
        for (int i = 0; i < count; ++i) {
            threads.emplace_back([&, i] {
                const auto k = static_cast<std::size_t>(i);
                MeetingExchange exchange(meeting, i < workers ? i : -1, workers, listeners);
                shares[k] = processes[k]
                                ->play(&exchange, i + 1 == count ? checkpoint : nullptr)
                                .ambient.computed;
            });
        }
        for (std::thread& thread : threads) thread.join();
    }
    [[nodiscard]] std::uint64_t computed() const {
        return std::accumulate(shares.begin(), shares.end(), std::uint64_t{0});
    }
    std::vector<std::unique_ptr<Process>> processes;
    std::vector<std::uint64_t> shares;  ///< values that each computed
};

bool same_bytes(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

}  // namespace

TEST_CASE("values of a round see those of earlier rounds only: none is stored while rays travel") {
    for (const int bounces : {1, 2}) {
        Process process(bounces, 2);
        CHECK(process.play().complete);
        CHECK(process.watched.while_at_work == 0);
        CHECK(process.watched.between > 0);
        CHECK(static_cast<std::size_t>(process.watched.between) == process.shared.size());
    }
}

TEST_CASE("rounds end when every point is served, and few of their values were needless") {
    Process process(2, 2);
    GroupOfOne alone;
    std::vector<std::size_t> left;
    AmbientRounds rounds(process.scene.tracer, process.cache, process.executor, process.contexts,
                         alone, process.stop, [&](std::size_t n) { left.push_back(n); });
    const std::vector<AmbientPoint> points = rounds.collect([&] { process.look(); });
    CHECK(points.size() > 100);
    CHECK(process.contexts.ambient().computed == 0);  // points are found, not computed
    CHECK(process.contexts.rays().shadow == 0);
    rounds.compute_in_rounds(points);
    CHECK(rounds.collect([&] { process.look(); }).empty());
    REQUIRE(rounds.counts().size() == 2);
    for (const AmbientRounds::Counts& counts : rounds.counts()) {
        CHECK(counts.rounds > 1);
        CHECK(counts.values > 20);
        CHECK(counts.needless * 5 < counts.values);
    }
    REQUIRE_FALSE(left.empty());
    CHECK(left.back() == 0);
    CHECK(std::is_sorted(left.rbegin(), left.rend()));
    CHECK(rounds.counts()[0].new_records == 0);
    CHECK_FALSE(rounds.stopped());
}

TEST_CASE("processes that do the same rounds share the work and end with the same cache") {
    for (const int bounces : {1, 2}) {
        Process one(bounces, 1);
        const std::uint64_t computed = one.play().ambient.computed;
        const std::vector<Rgb> picture = one.picture();
        for (const int count : {2, 3}) {
            const Together all(bounces, count, 0, nullptr);
            for (const std::uint64_t share : all.shares) CHECK(share < computed);
            CHECK(all.computed() == computed);
            for (const auto& process : all.processes)
                CHECK(same_bytes(process->picture(), picture));
        }
    }
}

TEST_CASE("who takes part in rounds but computes nothing ends with the same cache, too") {
    Process one(2, 1);
    const std::uint64_t computed = one.play().ambient.computed;
    for (const int workers : {1, 2}) {
        const Together all(2, workers, 1, nullptr);
        CHECK(all.shares.back() == 0);
        CHECK(all.computed() == computed);
        CHECK(same_bytes(all.processes.back()->picture(), one.picture()));
    }
}

TEST_CASE("rounds that a checkpoint has kept are not computed again, whoever goes on") {
    Process whole(2, 1);
    KeptSteps kept;
    const std::uint64_t computed = whole.play(nullptr, &kept).ambient.computed;
    const std::vector<Rgb> picture = whole.picture();
    REQUIRE(kept.steps.size() > 20);
    KeptSteps half = kept;
    half.steps.resize(kept.steps.size() / 2);  // killed there
    {
        Process again(2, 1);
        KeptSteps steps = half;
        const std::uint64_t rest = again.play(nullptr, &steps).ambient.computed;
        CHECK(rest > 0);
        CHECK(rest < computed);
        CHECK(steps.steps.size() == kept.steps.size());
        CHECK(same_bytes(again.picture(), picture));
    }
    for (const int listeners : {0, 1}) {  // the checkpoint is of who listens, or of a worker
        KeptSteps steps = half;
        const Together all(2, 2, listeners, &steps);
        CHECK(all.computed() < computed);
        for (const auto& process : all.processes) CHECK(same_bytes(process->picture(), picture));
        KeptSteps of_all = kept;
        CHECK(Together(2, 2, listeners, &of_all).computed() == 0);
        CHECK(of_all.steps.size() == kept.steps.size());
    }
}

TEST_CASE("rounds that began with another cache are not gone on with") {
    KeptSteps kept;
    Process first(1, 1);
    (void)first.play(nullptr, &kept);
    KeptSteps of_other = kept;
    Process other(1, 1), same(1, 1);
    for (Process* process : {&other, &same}) {
        AmbientRecord record;
        record.radius = {.05f, .05f};
        record.value = {1, 1, 1};
        process->shared.insert(record);
    }
    (void)other.play(nullptr, &of_other);
    CHECK(of_other.beginning != kept.beginning);
    CHECK(same.play(nullptr, &of_other).ambient.computed == 0);
    CHECK(same_bytes(same.picture(), other.picture()));
}

TEST_CASE("a stop that one process wants stops all") {
    constexpr int kCount = 3;
    Meeting meeting(kCount);
    std::vector<std::unique_ptr<Process>> processes;
    for (int i = 0; i < kCount; ++i) processes.push_back(std::make_unique<Process>(2, 1));
    Process& impatient = *processes[1];
    impatient.told = [&] { impatient.stop.request(); };
    std::array<bool, kCount> complete{};
    std::vector<std::thread> threads;
    for (int i = 0; i < kCount; ++i) {
        threads.emplace_back([&, i] {
            const auto k = static_cast<std::size_t>(i);
            MeetingExchange exchange(meeting, i, kCount);
            complete[k] = processes[k]->play(&exchange).complete;
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const bool done : complete) CHECK_FALSE(done);
}
