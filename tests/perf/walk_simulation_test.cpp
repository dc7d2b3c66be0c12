#include "perf/model/walk_simulation.h"

#include <doctest/doctest.h>

using namespace lightwalk;

namespace {

/// Messages that cost nothing.
Machine free_messages() {
    Machine machine;
    machine.latency = machine.overhead = machine.byte_work = machine.gap = machine.byte_gap = 0;
    machine.step = machine.oversleep = machine.wake = machine.look = 0;
    machine.sleeps = false;
    return machine;
}

WalkCosts some_costs() {
    WalkCosts costs;
    costs.project = 30e-9;
    costs.check = 300e-9;
    costs.trace = 10e-6;
    costs.keep = 5e-9;
    costs.encode = 40e-9;
    costs.decode = 20e-9;
    costs.points = 1.5;
    costs.uncached = 0;
    return costs;
}

constexpr double kPixels = 640.0 * 480;

/// Of a frame without uncached pixels, but for what rank 0's program does alone.
double spread_seconds(const WalkCosts& c) {
    return kPixels * (c.check + c.encode + c.points * (c.project + c.keep));
}

WalkPrediction predicted(const WalkCosts& costs, const Machine& machine, int ranks, int threads,
                         int projectors = 32) {
    SimulatedWalk walk;
    walk.ranks = ranks;
    walk.threads = threads;
    walk.projectors = projectors;
    return WalkSimulation(costs, machine, walk).run();
}

}  // namespace

TEST_CASE("walk model: where messages are free all but the last step is shared by all cores") {
    const WalkCosts costs = some_costs();
    for (const auto& [ranks, threads] :
         {std::pair{1, 1}, std::pair{1, 4}, std::pair{4, 1}, std::pair{4, 4}, std::pair{12, 2}}) {
        CAPTURE(ranks);
        CAPTURE(threads);
        // Rank 0's threads share the others' parts.
        const int parts = (ranks - 1 + threads - 1) / threads;
        const double alone = costs.decode * kPixels * parts / ranks;
        const WalkPrediction p = predicted(costs, free_messages(), ranks, threads);
        CHECK(p.seconds ==
              doctest::Approx(spread_seconds(costs) / (ranks * threads) + alone).epsilon(0.01));
        CHECK(p.projected + p.checked + p.traced + p.gathered == doctest::Approx(p.seconds));
    }
}

TEST_CASE("walk model: no more ranks than there are projectors share the points") {
    const WalkCosts costs = some_costs();
    const WalkPrediction few = predicted(costs, free_messages(), 4, 1);
    const WalkPrediction many = predicted(costs, free_messages(), 16, 1, 4);
    CHECK(many.seconds == doctest::Approx(few.seconds));
}

TEST_CASE("walk model: uncached pixels are traced by all ranks, whichever part they lie in") {
    WalkCosts costs = some_costs();
    costs.uncached = 0.05;
    const double without = predicted(some_costs(), free_messages(), 4, 2).seconds;
    const WalkPrediction p = predicted(costs, free_messages(), 4, 2);
    const double tracing = costs.trace * costs.uncached * kPixels / 8;
    CHECK(p.seconds - without > 0.7 * tracing);  // a frame's uncached pixels vary
    CHECK(p.seconds - without < 1.4 * tracing);
    CHECK(p.uncached_of_fullest > 1);
}

TEST_CASE("walk model: what messages cost is added") {
    const WalkCosts costs = some_costs();
    Machine machine = free_messages();
    const WalkPrediction fast = predicted(costs, machine, 4, 1);
    CHECK(fast.master_busy == 0);
    machine.latency = 1e-3;
    // Order, points, used points and uncached pixels, their dealing out, the part: at least three
    // in a row.
    CHECK(predicted(costs, machine, 4, 1).seconds > fast.seconds + 3e-3);
    machine.latency = 0;
    machine.byte_work = 1e-8;
    const WalkPrediction slow = predicted(costs, machine, 4, 1);
    CHECK(slow.master_busy > 0);
    CHECK(slow.seconds - fast.seconds > 0.5 * machine.byte_work * costs.packed_bytes * kPixels);
    CHECK(slow.bytes_a_frame > 0.7 * costs.packed_bytes * kPixels);
}
