#pragma once
// Register code of a program, and its instruction set.
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/function/program.h"

namespace lightwalk::function {

/// The rows of instructions.def; then of library.def each function's own, which is checked, and
/// each reduction's step, which is not.
enum class Op : std::uint8_t {
#define INSTRUCTION(name, operands, lanes) name,
#include "core/function/instructions.def"
#define SPECIAL_FORM(name, spelling, arguments)
#define REDUCTION(name, value) name, name##_step,
#define ANY_FUNCTION(name) name,
#include "core/function/library.def"
};

/// What a row says of an instruction.
struct OpEntry {
    const char* name;
    const char* operands;
    bool lanes;  ///< evaluations side by side know it
};
[[nodiscard]] const OpEntry& op_entry(Op op);

struct Instruction {
    Op op = Op::halt;
    std::uint8_t error_mask = 0;  ///< of checked ones: 0 clears the error flag first, 0xff keeps it
    std::uint32_t dst = 0, a = 0, b = 0, c = 0;
};

/// A frame: a call's cells. First the cached ones, each of which has a flag that tells whether its
/// value is valid: parameters, then thunks. Then temporaries.
struct FunctionCode {
    std::uint32_t entry = 0;
    std::uint32_t cells = 0;
    std::uint32_t cached = 0;
    std::uint32_t parameters = 0;
    std::uint32_t cost = 0;  ///< instructions
};

/// An argument: a cell of the caller, or the block of the caller that computes it.
struct Argument {
    bool is_value = false;
    std::uint32_t at = 0;
};

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
    std::vector<std::uint8_t> used_channels;  ///< those that instructions read from cells
    ChannelMask channels = 0;
    std::uint32_t inputs_at = 0;
    std::uint32_t thunks_at = 0;
    std::uint32_t thunks = 0;
    std::uint32_t cells = 0;
    std::vector<double> reals;
    SourceLocation where;
    bool has_lanes = false;  ///< evaluate_lanes knows all instructions
};

}  // namespace lightwalk
