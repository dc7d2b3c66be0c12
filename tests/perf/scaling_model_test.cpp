#include <doctest/doctest.h>

#include "core/error.h"
#include "perf/model/cost_map.h"
#include "perf/model/processors.h"
#include "perf/model/simulation.h"

using namespace lightwalk;

namespace {

/// A picture whose cells take more and more from left to right.
CostMap slanting_map(int width, int height, double cell_seconds) {
    CostMap map;
    map.picture.width = width;
    map.picture.height = height;
    for (int y = 0; y < map.picture.rows(); ++y) {
        for (int x = 0; x < map.picture.columns(); ++x)
            map.picture.seconds.push_back(cell_seconds * (x + 1));
    }
    return map;
}

double total(const CostMap& map) {
    double sum = 0;
    for (const double seconds : map.picture.seconds) sum += seconds;
    return sum;
}

CostMap with_values(CostMap map) {
    map.picture.values.assign(map.picture.seconds.size(), 1);
    map.picture.making.assign(map.picture.seconds.size(), .002);
    return map;
}

SimulatedRun some_run(Variant variant, int ranks, int threads) {
    SimulatedRun run;
    run.variant = variant;
    run.ranks = ranks;
    run.threads = threads;
    run.width = 250;
    run.height = 130;
    return run;
}

Machine with_cores(int cores) {
    Machine machine;
    machine.node_cores = cores;
    return machine;
}

}  // namespace

TEST_CASE("any partition of a picture costs what the whole does, at any resolution") {
    const CostMap map = slanting_map(250, 130, 1e-3);
    for (const int scale : {1, 3}) {
        const BlockCosts costs(map.picture, 250 * scale, 130 * scale);
        double sum = 0;
        for (int y = 0; y < 130 * scale; y += 27) {
            for (int x = 0; x < 250 * scale; x += 41)
                sum += costs.seconds(
                    {x, y, std::min(x + 41, 250 * scale), std::min(y + 27, 130 * scale)});
        }
        CHECK(sum == doctest::Approx(total(map) * scale * scale));
    }
    CHECK(BlockCosts(map.picture, 250, 130).seconds({8, 0, 16, 8}) == doctest::Approx(2e-3));
}

TEST_CASE("threads share the cores of a node evenly") {
    Processors node(2, {1}, 0);
    node.add(0, 1, 3);
    node.add(0, 2, 3);
    CHECK(node.next(0)->first == doctest::Approx(3));
    node.add(1, 3, 1);  // three on two cores, each at two thirds
    CHECK(node.next(1)->second == 3);
    CHECK(node.next(1)->first == doctest::Approx(2.5));
    node.remove(2.5, 3);
    CHECK(node.next(2.5)->first == doctest::Approx(3.5));
    node.take_away(3, .5);  // each of two loses a quarter of a second
    CHECK(node.next(3)->first == doctest::Approx(3.75));
    Processors shared(2, {1}, 0, 3);  // with three threads of others
    shared.add(0, 1, 1);
    CHECK(shared.next(0)->first == doctest::Approx(2));
    Processors crowded(2, {1, 1.25}, 0);
    crowded.add(0, 1, 1);
    crowded.add(0, 2, 1);
    CHECK(crowded.next(0)->first == doctest::Approx(1.25));
}

TEST_CASE("one thread takes the sum of the blocks' times") {
    const CostMap map = slanting_map(250, 130, 1e-3);
    const Prediction p = Simulation(map, {}, some_run(Variant::threads, 1, 1)).run();
    CHECK(p.seconds == doctest::Approx(total(map)));
    CHECK(p.tracing_seconds == doctest::Approx(total(map)));
}

TEST_CASE("no work is lost or doubled, and no speed-up exceeds the cores that trace") {
    const CostMap map = slanting_map(250, 130, 1e-3);
    for (const Variant variant : {Variant::ranks, Variant::hybrid}) {
        for (const int ranks : {2, 5, 17}) {
            for (const int threads : {1, 3}) {
                if (variant == Variant::ranks && threads > 1) continue;
                for (const int stride : {0, 1}) {
                    CAPTURE(ranks);
                    SimulatedRun run = some_run(variant, ranks, threads);
                    run.stride = stride;
                    const Prediction p = Simulation(map, with_cores(threads), run).run();
                    const int tracing = (variant == Variant::ranks ? ranks - 1 : ranks) * threads;
                    CHECK(p.tracing_seconds == doctest::Approx(total(map)).epsilon(1e-6));
                    CHECK(p.seconds > total(map) / tracing);
                    CHECK(p.seconds < 2.5 * total(map) / tracing);
                }
            }
        }
    }
}

TEST_CASE("a node's cores bound the speed-up of all ranks on it") {
    const CostMap map = slanting_map(250, 130, 1e-3);
    Machine machine = with_cores(2);
    machine.node_ranks = 0;
    const Prediction p = Simulation(map, machine, some_run(Variant::ranks, 9, 1)).run();
    CHECK(p.seconds > total(map) / 2);
    CHECK(p.seconds < 1.2 * total(map) / 2);
}

TEST_CASE("the same seed gives the same prediction") {
    const CostMap map = with_values(slanting_map(250, 130, 1e-3));
    SimulatedRun run = some_run(Variant::hybrid, 6, 2);
    run.ambient = true;
    const double first = Simulation(map, with_cores(2), run).run().seconds;
    CHECK(Simulation(map, with_cores(2), run).run().seconds == first);
    run.seed = 2;
    CHECK(Simulation(map, with_cores(2), run).run().seconds != first);
}

TEST_CASE("masters below the master relieve it") {
    const CostMap map = slanting_map(2000, 1000, 1e-5);
    Machine machine;
    machine.overhead = 100e-6;
    SimulatedRun run = some_run(Variant::ranks, 401, 1);
    run.width = 2000;
    run.height = 1000;
    run.masters = 1;
    const Prediction one = Simulation(map, machine, run).run();
    run.ranks = 411;
    run.masters = 11;
    const Prediction tree = Simulation(map, machine, run).run();
    CHECK(tree.seconds < .8 * one.seconds);
    CHECK(tree.master_seconds < .5 * one.master_seconds);
}

TEST_CASE("who shares ambient values makes fewer of them") {
    const CostMap map = with_values(slanting_map(250, 130, 1e-4));
    SimulatedRun run = some_run(Variant::ranks, 6, 1);
    run.ambient = true;
    run.ambient_batch = 4;
    const Prediction shared = Simulation(map, {}, run).run();
    CHECK(shared.values_made >= shared.values_needed);
    run.ambient_batch = 0;
    const Prediction alone = Simulation(map, {}, run).run();
    CHECK(alone.values_made > shared.values_made);
    SimulatedRun threads = some_run(Variant::threads, 1, 4);
    threads.ambient = true;
    const Prediction one_cache = Simulation(map, with_cores(4), threads).run();
    CHECK(one_cache.values_made == one_cache.values_needed);
}

TEST_CASE("a cost map or a machine that is none is refused") {
    CHECK_THROWS_AS((void)read_cost_map(nlohmann::json::parse("{}")), InputError);
    CHECK_THROWS_AS((void)read_cost_map(nlohmann::json::parse(
                        R"({"picture": {"width": 20, "height": 8, "cell": 8, "seconds": [1]},
                            "setup_seconds": 0, "block_seconds": 0, "encode_seconds": 0,
                            "decode_seconds": 0, "packed_bytes": 6})")),
                    InputError);
    CHECK_THROWS_WITH_AS((void)read_machine(nlohmann::json::parse(R"({"latencie": 1})")),
                         doctest::Contains("latencie"), InputError);
    CHECK(read_machine(nlohmann::json::parse(R"({"latency": 2.5})")).latency == 2.5);
}
