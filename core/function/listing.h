#pragma once
// Listings of graphs and code, which show how an expression is compiled. README.md beside this file
// explains an example.
#include <string>

#include "core/function/code.h"
#include "core/function/graph.h"

namespace lightwalk::function {

/// A listing of a graph: one line for each output, thunk and function instance.
[[nodiscard]] std::string listing(const Graph& graph);

/// A listing of code: one line for each instruction. Numbers that are not values (jump targets,
/// tables) are marked by #.
[[nodiscard]] std::string listing(const Program::Code& code);

}  // namespace lightwalk::function
