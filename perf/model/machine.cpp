#include "perf/model/machine.h"

#include <map>

#include "core/error.h"

namespace lightwalk {

Machine read_machine(const nlohmann::json& json) {
    Machine m;
    const std::map<std::string, double*> reals{
        {"latency", &m.latency},     {"overhead", &m.overhead},
        {"byte_work", &m.byte_work}, {"gap", &m.gap},
        {"byte_gap", &m.byte_gap},   {"step", &m.step},
        {"oversleep", &m.oversleep}, {"wake", &m.wake},
        {"look", &m.look},           {"background", &m.background},
        {"slowness", &m.slowness},   {"value_work", &m.value_work}};
    try {
        for (const auto& [name, value] : json.items()) {
            if (const auto real = reals.find(name); real != reals.end())
                *real->second = value.get<double>();
            else if (name == "name")
                m.name = value;
            else if (name == "sleeps")
                m.sleeps = value;
            else if (name == "unpacks")
                m.unpacks = value;
            else if (name == "node_cores")
                m.node_cores = value;
            else if (name == "node_ranks")
                m.node_ranks = value;
            else if (name == "crowding")
                m.crowding = value.get<std::vector<double>>();
            else if (name != "source")  // where the figures come from
                throw InputError("a machine has no \"" + name + "\"");
        }
    } catch (const nlohmann::json::exception& error) {
        throw InputError(std::string("a machine: ") + error.what());
    }
    if (m.node_cores < 1 || m.node_ranks < 0 || m.crowding.empty() || m.background < 0 ||
        !(m.slowness > 0))
        throw InputError("a machine has at least one core, and takes some time");
    return m;
}

}  // namespace lightwalk
