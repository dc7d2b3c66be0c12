// Predicts how long a frame of a walk takes on ranks and threads that need not exist.
//   walk_model CASES.json > predictions.json
// CASES: {"costs": WalkCosts by name, "machines": {NAME: Machine}, "cases": [{"name", "machine",
// "ranks", "threads", "projectors", "width", "height"}]}. README.md beside this file says what is
// assumed.
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "perf/model/walk_simulation.h"

namespace {

using namespace lightwalk;
using Json = nlohmann::ordered_json;

WalkCosts read_costs(const nlohmann::json& json) {
    WalkCosts c;
    const std::map<std::string, double*> names{
        {"project", &c.project}, {"check", &c.check},    {"trace", &c.trace},
        {"keep", &c.keep},       {"encode", &c.encode},  {"decode", &c.decode},
        {"points", &c.points},   {"holes", &c.uncached}, {"packed_bytes", &c.packed_bytes},
        {"shift", &c.shift}};
    for (const auto& [name, value] : json.items()) {
        if (names.find(name) == names.end())
            throw InputError("a walk's costs have no \"" + name + "\"");
        *names.at(name) = value.get<double>();
    }
    return c;
}

SimulatedWalk read_walk(const nlohmann::json& json) {
    SimulatedWalk walk;
    walk.ranks = json.value("ranks", walk.ranks);
    walk.threads = json.value("threads", walk.threads);
    walk.projectors = json.value("projectors", walk.projectors);
    walk.width = json.value("width", walk.width);
    walk.height = json.value("height", walk.height);
    walk.frames = json.value("frames", walk.frames);
    if (walk.ranks < 1 || walk.threads < 1 || walk.projectors < 1 || walk.width < 1 ||
        walk.height < 1 || walk.frames < 2)
        throw InputError("a walk has ranks, threads, projectors and pixels, and two frames");
    return walk;
}

Json predictions(const nlohmann::json& cases) {
    const WalkCosts costs = read_costs(cases.at("costs"));
    Json all = Json::array();
    for (const nlohmann::json& one : cases.at("cases")) {
        const Machine machine =
            read_machine(cases.at("machines").at(one.at("machine").get<std::string>()));
        const WalkPrediction p = WalkSimulation(costs, machine, read_walk(one)).run();
        Json row(one);
        row["seconds"] = p.seconds;
        row["projected"] = p.projected;
        row["checked"] = p.checked;
        row["traced"] = p.traced;
        row["gathered"] = p.gathered;
        row["master_busy"] = p.master_busy;
        row["bytes_a_frame"] = p.bytes_a_frame;
        row["holes_of_fullest"] = p.uncached_of_fullest;
        all.push_back(std::move(row));
    }
    return {{"predictions", std::move(all)}};
}

}  // namespace

int main(int count, char** words) {
    try {
        if (count != 2) throw InputError("usage: walk_model CASES.json");
        std::ifstream file(words[1]);
        if (!file) throw InputError(std::string("cannot read ") + words[1]);
        std::printf("%s\n", predictions(nlohmann::json::parse(file)).dump(1).c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "walk_model: %s\n", error.what());
        return 1;
    }
}
