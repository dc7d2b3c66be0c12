#pragma once
// The graph of a primitive's expressions after specialisation: its real arguments are substituted,
// user functions inlined, constants folded, and branches that are never taken removed.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/function/expression.h"
#include "core/function/library.h"
#include "core/function/program.h"
#include "core/function/symbols.h"

namespace lightwalk::function {

using NodeId = std::uint32_t;
using ThunkId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xffffffffu;

enum class NodeKind : std::uint8_t {
    constant,   ///< `value`; evaluating it may clear the error flag, see Node
    channel,    ///< `index`: Channel
    input,      ///< the index-th argument that an output is called with
    thunk,      ///< `index`: ThunkId
    parameter,  ///< parameter of the function instance, evaluated by need
    sum,        ///< sum of the kids, starting from 0, left to right
    product,    ///< product of the kids, starting from 1, left to right
    difference,
    quotient,  ///< the divisor is evaluated first
    negation,
    power,        ///< the exponent is evaluated first
    library,      ///< `index`: LibraryFunction, of kids
    conditional,  ///< if(kids[0], kids[1], kids[2])
    choice,       ///< select(kids[0], kids[1], ...)
    check,        ///< a library call of which only the chosen argument kids[0] is left
    call,         ///< of function instance `index`, kids by need
    fatal,        ///< error message `index`
};

/// Evaluating a node may change the language's error flag; folding it to a constant must not hide
/// that. A constant (and a check before its argument) may only clear the flag: always if `clears`;
/// and when it is the first in its epoch to need one of `folded_thunks`, thunks with a constant
/// value, whose evaluation would have cleared it. Those are never evaluated, but their cells are
/// marked as valid.
struct Node {
    NodeKind kind = NodeKind::constant;
    bool clears = false;
    std::uint32_t index = 0;
    double value = 0;
    std::vector<NodeId> kids;
    std::vector<ThunkId> folded_thunks;
};

/// An expression that is evaluated when its value is first needed and then cached (call by need): a
/// variable, or an argument of an inlined call. The cache lasts for an epoch, or for a call.
struct Thunk {
    NodeId body = kNoNode;
    std::uint32_t frame = 0;  ///< 0: the global frame; k + 1: the frame of a call of instance k
    std::uint32_t output = kNoNode;  ///< the output that it belongs to, whose start invalidates it
    [[nodiscard]] bool is_global() const { return frame == 0; }
};

/// An instance of a user function that is called rather than inlined; its function-valued arguments
/// are substituted.
struct Instance {
    SymbolId symbol = kNoSymbol;
    std::vector<SymbolId> functions;  ///< what each parameter names; kNoSymbol where it is a value
    NodeId body = kNoNode;
};

struct Graph {
    std::vector<Node> nodes;
    std::vector<Thunk> thunks;
    std::vector<Instance> instances;
    std::vector<NodeId> outputs;
    std::vector<std::uint32_t> inputs;  ///< number of arguments that each output is called with
    std::vector<std::string> messages;
};

/// Options of building a graph.
struct Specialisation {
    const SymbolTable& symbols;
    std::span<const double> reals;
    ChannelMask material_channels = 0;
    bool constant = false;  ///< evaluated while parsing: channels and arg(n) are errors
    SourceLocation where;   ///< for messages
};

/// One output: an expression of the arguments that it is called with (as parameters $0, $1, ...).
struct OutputRequest {
    Expr expression;
    std::uint32_t inputs = 0;
};

/// `effort` is increased by the work done. Throws InputError when there are too many function
/// instances.
[[nodiscard]] Graph build_graph(const Specialisation& specialisation,
                                std::span<const OutputRequest> outputs, std::uint64_t& effort);

}  // namespace lightwalk::function
