#pragma once
// Register code of a program, and its instruction set.
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/function/program.h"

namespace lightwalk::function {

/// The instructions: the rows of instructions.def, then one for each function of library.def (which
/// checks for errors) and one for the step of each reduction (which does not).
enum class Op : std::uint8_t {
#define INSTRUCTION(name, operands, lanes) name,
#include "core/function/instructions.def"
#define SPECIAL_FORM(name, spelling, arguments)
#define REDUCTION(name, value) name, name##_step,
#define ANY_FUNCTION(name) name,
#include "core/function/library.def"
};

/// Properties of an instruction, from its row.
struct OpEntry {
    const char* name;
    const char* operands;
    bool lanes;  ///< available in SIMD evaluation of several rays (lanes)
};
[[nodiscard]] const OpEntry& op_entry(Op op);

struct Instruction {
    Op op = Op::halt;
    std::uint8_t error_mask =
        0;  ///< for checked instructions: 0 clears the error flag first, 0xff keeps it
    std::uint32_t dst = 0, a = 0, b = 0, c = 0;
};

/// The layout of the cells (registers) of a call: first cached cells, each with a flag that tells
/// whether its value is valid (parameters, then thunks), then temporaries.
struct FunctionCode {
    std::uint32_t entry = 0;
    std::uint32_t cells = 0;
    std::uint32_t cached = 0;
    std::uint32_t parameters = 0;
    std::uint32_t cost = 0;                    ///< instructions
    std::uint32_t first_known = 0, known = 0;  ///< values of 0, 1, ..., see remember_values()
};

/// An argument of a call: a cell of the caller, or the code block of the caller that computes it.
struct Argument {
    bool is_value = false;
    std::uint32_t at = 0;
};

/// What the calls of one epoch may use: recursion of a function file that does not end is an error
/// long before a user gives up.
inline constexpr std::uint64_t kMostOperations = 100000000;

struct OutputCode {
    std::uint32_t entry = 0;
    std::uint32_t inputs = 0;
    bool is_constant = false;
    double value = 0;
};

}  // namespace lightwalk::function

namespace lightwalk {

/// The global frame, whose values live as long as the epoch: channels, constants, inputs, thunks,
/// temporaries.
struct Program::Code {
    std::vector<function::Instruction> instructions;
    std::vector<function::OutputCode> outputs;
    std::vector<function::FunctionCode> functions;
    std::vector<function::Argument> arguments;
    std::vector<std::uint32_t> targets;
    std::vector<std::string> messages;
    std::vector<double> constants;
    std::vector<double> known;                ///< values of functions, see FunctionCode
    std::vector<std::uint8_t> used_channels;  ///< channels that instructions read from cells
    ChannelMask channels = 0;
    std::uint32_t inputs_at = 0;
    std::uint32_t thunks_at = 0;
    std::uint32_t thunks = 0;
    std::uint32_t cells = 0;
    std::vector<double> reals;
    SourceLocation where;
    bool has_lanes = false;  ///< all instructions are available in evaluate_lanes
};

}  // namespace lightwalk
