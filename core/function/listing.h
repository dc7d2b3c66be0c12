#pragma once
// Graphs and code as text: what becomes of an expression. README.md beside this file reads one.
#include <string>

#include "core/function/code.h"
#include "core/function/graph.h"

namespace lightwalk::function {

/// A line for each output, thunk and function instance.
[[nodiscard]] std::string listing(const Graph& graph);

/// A line for each instruction; # stands before numbers that are no values: targets, tables.
[[nodiscard]] std::string listing(const Program::Code& code);

}  // namespace lightwalk::function
