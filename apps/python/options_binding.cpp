// The options of commands, as the package checks and documents keyword arguments by them.
#include <pybind11/stl.h>

#include "apps/contrib_command.h"
#include "apps/python/bindings.h"
#include "apps/render_command.h"
#include "apps/trace_command.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

struct OfferedOption {
    std::string name, words, text, value;
    bool is_switch;  ///< the name alone, or with + or - attached
};

OptionTable options_of(const std::string& command) {
    const auto table = [](auto& made) { return option_table(made, real_files()); };
    if (command == "trace") return owning_table(TraceCommand(), table);
    if (command == "contrib") return owning_table(ContribCommand(), table);
    if (command == "render" || command == "animate" || command == "walk")
        return owning_table(RenderCommand(command), table);
    throw UsageError("no such command: " + command);
}

std::vector<OfferedOption> offered_options(const std::string& command) {
    std::vector<OfferedOption> offered;
    const OptionTable table = options_of(command);
    for (const OptionRow& row : table.rows()) {
        if (!row.offered()) continue;
        offered.push_back({row.name(), row.words, row.help(), row.default_text(),
                           std::holds_alternative<bool*>(row.place) ||
                               std::holds_alternative<Action>(row.place)});
    }
    return offered;
}

}  // namespace

void bind_options(py::module_& module) {
    py::class_<OfferedOption>(module, "OfferedOption")
        .def_readonly("name", &OfferedOption::name)
        .def_readonly("words", &OfferedOption::words)
        .def_readonly("text", &OfferedOption::text)
        .def_readonly("value", &OfferedOption::value)
        .def_readonly("is_switch", &OfferedOption::is_switch);
    module.def("offered_options", &offered_options, py::arg("command"));
}

}  // namespace lightwalk
