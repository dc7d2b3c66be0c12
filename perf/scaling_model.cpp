// Predicts how long a picture takes on ranks and threads that need not exist.
//   scaling_model CASES.json > predictions.json
// README.md beside this file says what CASES holds, and what is assumed.
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "perf/model/simulation.h"

namespace {

using namespace lightwalk;
using Json = nlohmann::ordered_json;

nlohmann::json read_json(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw InputError("cannot read " + path);
    try {
        return nlohmann::json::parse(file);
    } catch (const nlohmann::json::exception& error) {
        throw InputError(path + ": " + error.what());
    }
}

Variant variant_named(const std::string& name) {
    if (name == "threads") return Variant::threads;
    if (name == "ranks") return Variant::ranks;
    if (name == "hybrid") return Variant::hybrid;
    throw InputError("expected a variant: threads, ranks or hybrid; found \"" + name + "\"");
}

SimulatedRun read_run(const nlohmann::json& json, const CostMap& map) {
    SimulatedRun run;
    run.variant = variant_named(json.value("variant", "ranks"));
    run.ranks = json.value("ranks", 1);
    run.threads = json.value("threads", 1);
    run.width = json.value("width", map.picture.width);
    run.height = json.value("height", map.picture.height);
    run.alignment = json.value("alignment", map.picture.cell);
    run.block = json.value("block", 0);
    run.stride = json.value("stride", 0);
    run.masters = json.value("masters", 0);
    run.ambient_batch = json.value("ambient_batch", 16);
    run.ambient = !map.picture.values.empty();
    run.seed = json.value("seed", 1);
    if (run.ranks < 1 || run.threads < 1 || run.width < 1 || run.height < 1 || run.alignment < 1)
        throw InputError("a run has ranks, threads, pixels and an alignment of at least 1");
    return run;
}

Json counts_of(const MessageCounts& counts) {
    Json json;
    for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
        if (counts.messages[kind] > 0)
            json[kind_name(kind)] = {{"count", counts.messages[kind]},
                                     {"bytes", counts.bytes[kind]}};
    }
    return json;
}

/// Every pixel takes `work` times what was measured, as with several samples a pixel.
CostMap with_work(CostMap map, double work) {
    for (CellCosts* cells : {&map.picture, &map.prepass}) {
        for (double& seconds : cells->seconds) seconds *= work;
    }
    return map;
}

/// All there is to say of one case, and how long the simulation took.
Json predict(const nlohmann::json& wanted, const CostMap& map, const Machine& machine,
             double base) {
    using Clock = std::chrono::steady_clock;
    const SimulatedRun run = read_run(wanted, map);
    const Clock::time_point begin = Clock::now();
    const Prediction p = Simulation(map, machine, run).run();
    const double cores =
        static_cast<double>(run.variant == Variant::threads ? 1 : run.ranks) * run.threads;
    Json json(wanted);
    json["seconds"] = p.seconds;
    json["seconds_on_one"] = base;
    json["speedup"] = base / p.seconds;
    json["efficiency"] = base / p.seconds / cores;
    json["tracing_seconds"] = p.tracing_seconds;
    json["master_busy"] = p.master_seconds / p.seconds;
    json["busiest_busy"] = p.busiest_seconds / p.seconds;
    json["blocks"] = p.blocks;
    if (run.ambient) {
        json["values_made"] = p.values_made;
        json["values_needed"] = p.values_needed;
    }
    json["owner_share"] = p.owner_share;
    json["messages"] = counts_of(p.messages);
    json["simulation_seconds"] = std::chrono::duration<double>(Clock::now() - begin).count();
    return json;
}

/// The nodes of a case: of its machine unless it names others.
Machine machine_of(const nlohmann::json& wanted, const nlohmann::json& machines) {
    nlohmann::json machine = machines.at(wanted.value("machine", "here"));
    for (const char* name : {"node_cores", "node_ranks"}) {
        if (wanted.contains(name)) machine[name] = wanted[name];
    }
    return read_machine(machine);
}

Json predict_all(const nlohmann::json& cases) {
    std::map<std::string, CostMap> maps;
    std::map<std::string, double> bases;
    Json found = Json::array();
    for (const nlohmann::json& wanted : cases.at("cases")) {
        const std::string path = wanted.value("map", cases.value("map", ""));
        const double work = wanted.value("work", 1.0);
        if (maps.find(path) == maps.end()) maps[path] = read_cost_map(read_json(path));
        const CostMap map = with_work(maps[path], work);
        const Machine machine = machine_of(wanted, cases.at("machines"));
        const SimulatedRun run = read_run(wanted, map);
        const std::string key = path + ' ' + wanted.value("machine", "here") + ' ' +
                                std::to_string(run.width) + 'x' + std::to_string(run.height) + ' ' +
                                std::to_string(work);
        if (bases.find(key) == bases.end()) bases[key] = seconds_on_one(map, machine, run);
        found.push_back(predict(wanted, map, machine, bases[key]));
        std::fprintf(stderr, "%s: %.3g s\n", wanted.value("name", "case").c_str(),
                     found.back()["seconds"].get<double>());
    }
    return {{"predictions", found}};
}

}  // namespace

int main(int count, char** words) {
    if (count != 2) {
        std::fprintf(stderr, "usage: scaling_model CASES.json > predictions.json\n");
        return 2;
    }
    try {
        std::printf("%s\n", predict_all(read_json(words[1])).dump(1).c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "scaling_model: %s\n", error.what());
        return 1;
    }
}
