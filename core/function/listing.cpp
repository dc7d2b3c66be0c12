#include "core/function/listing.h"

#include <array>
#include <cstdio>

#include "core/function/channel_names.h"

namespace lightwalk::function {
namespace {

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

std::string numbered(const char* what, std::size_t i) {
    return what + std::to_string(i);
}

// Graphs.

std::string expression(const Graph& graph, NodeId id);

std::string call(const std::string& name, const Graph& graph, const Node& n) {
    std::string text = name + "(";
    for (std::size_t i = 0; i < n.kids.size(); ++i)
        text += (i > 0 ? ", " : "") + expression(graph, n.kids[i]);
    return text + ")";
}

/// What evaluating a constant does besides, see Node.
std::string side_effects(const Node& n) {
    if (!n.clears && n.folded_thunks.empty()) return {};
    std::string text = n.clears ? " clears" : "";
    for (const ThunkId id : n.folded_thunks) text += numbered(" thunk", id);
    return "[" + text.substr(1) + "]";
}

std::string expression(const Graph& graph, NodeId id) {
    if (id == kNoNode) return "nothing";
    const Node& n = graph.nodes[id];
    switch (n.kind) {
        case NodeKind::constant:
            return number(n.value) + side_effects(n);
        case NodeKind::channel:
            return std::string(kChannelNames[n.index]);
        case NodeKind::input:
            return numbered("input", n.index);
        case NodeKind::thunk:
            return numbered("thunk", n.index);
        case NodeKind::parameter:
            return numbered("parameter", n.index);
        case NodeKind::sum:
            return call("sum", graph, n);
        case NodeKind::product:
            return call("product", graph, n);
        case NodeKind::difference:
            return call("difference", graph, n);
        case NodeKind::quotient:
            return call("quotient", graph, n);
        case NodeKind::negation:
            return call("negation", graph, n);
        case NodeKind::power:
            return call("power", graph, n);
        case NodeKind::library:
            return call(std::string(library_entry(static_cast<LibraryFunction>(n.index)).name),
                        graph, n);
        case NodeKind::conditional:
            return call("conditional", graph, n);
        case NodeKind::choice:
            return call("choice", graph, n);
        case NodeKind::check:
            return call("check" + side_effects(n), graph, n);
        case NodeKind::call:
            return call(numbered("instance", n.index), graph, n);
        case NodeKind::fatal:
            return "fatal \"" + graph.messages[n.index] + "\"";
    }
    return {};
}

// Code.

/// The function whose code holds instruction `at`; null in the global frame.
const FunctionCode* function_at(const Program::Code& code, std::size_t at) {
    for (const FunctionCode& f : code.functions) {
        if (at >= f.entry && at < std::size_t{f.entry} + f.cost) return &f;
    }
    return nullptr;
}

std::string cell(const Program::Code& code, const FunctionCode* function, std::uint32_t i) {
    if (function) {
        if (i < function->parameters) return numbered("parameter", i);
        if (i < function->cached) return numbered("thunk", i - function->parameters);
        return numbered("t", i - function->cached);
    }
    if (i < kChannelCount) return std::string(kChannelNames[i]);
    if (i < code.inputs_at) return number(code.constants[i - kChannelCount]);
    if (i < code.thunks_at) return numbered("input", i - code.inputs_at);
    if (i < code.thunks_at + code.thunks) return numbered("thunk", i - code.thunks_at);
    return numbered("t", i - code.thunks_at - code.thunks);
}

/// The field that an operand's letter in instructions.def names.
std::string operand(char letter, const Program::Code& code, const FunctionCode* function,
                    const Instruction& i) {
    const auto immediate = [](std::uint32_t value) {
        return "#" + std::to_string(static_cast<std::int32_t>(value));
    };
    switch (letter) {
        case 'D':
            return cell(code, function, i.dst);
        case 'G':
            return cell(code, nullptr, i.dst);
        case 'a':
            return cell(code, function, i.a);
        case 'b':
            return cell(code, function, i.b);
        case 'c':
            return cell(code, function, i.c);
        case 'g':
            return cell(code, nullptr, i.a);
        case 'A':
            return immediate(i.a);
        case 'B':
            return immediate(i.b);
        default:
            return immediate(i.c);
    }
}

std::string line(const Program::Code& code, std::size_t at) {
    const Instruction& i = code.instructions[at];
    const OpEntry& op = op_entry(i.op);
    const FunctionCode* function = function_at(code, at);
    std::string text = std::to_string(at);
    text.insert(0, text.size() < 3 ? 3 - text.size() : 0, ' ');
    text += "  ";
    std::string operands = op.operands;
    if (operands.starts_with('d')) {
        text += cell(code, function, i.dst) + " = ";
        operands.erase(0, 1);
    }
    text += op.name;
    for (std::size_t k = 0; k < operands.size(); ++k)
        text += (k > 0 ? ", " : " ") + operand(operands[k], code, function, i);
    if (i.error_mask != 0) text += " [keeps the error flag]";
    return text + "\n";
}

}  // namespace

std::string listing(const Graph& graph) {
    std::string text;
    for (std::size_t i = 0; i < graph.outputs.size(); ++i)
        text += numbered("output", i) + " = " + expression(graph, graph.outputs[i]) + "\n";
    for (std::size_t i = 0; i < graph.thunks.size(); ++i)
        text += numbered("thunk", i) + " = " + expression(graph, graph.thunks[i].body) + "\n";
    for (std::size_t i = 0; i < graph.instances.size(); ++i)
        text += numbered("instance", i) + " = " + expression(graph, graph.instances[i].body) + "\n";
    return text;
}

std::string listing(const Program::Code& code) {
    std::string text;
    for (std::size_t i = 0; i < code.instructions.size(); ++i) {
        for (std::size_t k = 0; k < code.functions.size(); ++k) {
            const FunctionCode& function = code.functions[k];
            if (function.cost > 0 && function.entry == i) text += numbered("instance", k) + ":\n";
        }
        for (std::size_t k = 0; k < code.outputs.size(); ++k) {
            if (code.outputs[k].entry == i) text += numbered("output", k) + ":\n";
        }
        text += line(code, i);
    }
    return text;
}

}  // namespace lightwalk::function
