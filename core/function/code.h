#pragma once
// Register code of a program, and its instruction set.
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/function/program.h"

namespace lightwalk::function {

/// Operands dst, a, b, c are cells of the present frame unless said otherwise. "Checked" operations
/// end with the language's test: a set error flag, or a result that is not finite, makes the result
/// 0.
// clang-format off
enum class Op : std::uint8_t {
    move, load_tick,      ///< dst = a; dst = cell a of the tick's frame
    negate, subtract, multiply, divide,  ///< plain IEEE
    add,                  ///< (0 + a) + b: a sum that starts here has no negative zero
    add3,                 ///< ((0 + a) + b) + c
    multiply3,            ///< (a * b) * c
    add_product,          ///< (0 + c) + (a * b), each operation rounded
    subtract_product,     ///< c - (a * b)
    lesser, greater,      ///< b if it is less (greater) than a, else a
    divide_tested,        ///< a / b; a range error when b is 0
    guard_divisor,        ///< if a is 0: dst = 0, range error, go to b
    half_power,           ///< a to the power of half the integer b (not a cell), checked
    power, min, max, rand, floor, ceil, sqrt, exp, log, log10, sin, cos, tan, asin, acos, atan,
    atan2, erf, erfc, noise3, noise3x, noise3y, noise3z, fnoise3, arg, source_theta, source_phi,
    source_corr, fprism_val,  ///< checked
    modulo, fraction,     ///< a - floor(a / b) * b; a - floor(a); floor checked
    absolute,             ///< max(a, -a), checked
    check,                ///< dst = a, checked
    pick,                 ///< dst = a > 0 ? b : c, checked
    clear,                ///< clear the error flag
    touch, touch_tick,    ///< clear it, the first time that cell dst is touched
    forget,               ///< cell dst has not been computed
    jump,                 ///< go to a
    jump_unless_positive, ///< if not a > 0 go to b
    jump_unless_above,    ///< if not a - c > 0 go to b
    choose,               ///< select a of c cases, targets from b: number, first, .., none
    ensure, ensure_tick,  ///< compute cell dst by the block at a, unless that has been done
    force,                ///< the same for parameter dst
    call,                 ///< dst = function a, arguments from b
    give,                 ///< end of a block: a is the cell's value
    give_call,            ///< end of a function: a is its value
    halt,                 ///< end of an output: a is its value
    fatal,                ///< throw message a
};
// clang-format on

/// Whether evaluations side by side know the operation.
[[nodiscard]] bool has_lanes(Op op);

struct Instruction {
    Op op = Op::halt;
    std::uint8_t keep = 0;  ///< checked: 0 clears the error flag first, 0xff keeps it
    std::uint32_t dst = 0, a = 0, b = 0, c = 0;
};

/// Cells of a frame: first those that are computed when needed (parameters first), then
/// temporaries.
struct FunctionCode {
    std::uint32_t entry = 0;
    std::uint32_t cells = 0;
    std::uint32_t marked = 0;  ///< cells with an "already computed" mark
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

/// The tick's frame: channels, constants, inputs, lazies, temporaries.
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
    std::uint32_t lazies_at = 0;
    std::uint32_t lazies = 0;
    std::uint32_t cells = 0;
    std::vector<double> reals;
    SourceLocation where;
    bool has_lanes = false;  ///< evaluate_lanes knows all instructions
};

}  // namespace lightwalk
