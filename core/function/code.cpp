#include "core/function/code.h"

#include "core/function/library.h"

namespace lightwalk::function {
namespace {

constexpr const char* operands_of(int arguments) {
    constexpr const char* kOperands[] = {"d", "da", "dab", "dabc"};
    return kOperands[arguments];
}

constexpr OpEntry kOps[] = {
#define INSTRUCTION(name, operands, lanes) {#name, operands, lanes},
#include "core/function/instructions.def"
#define SPECIAL_FORM(name, spelling, arguments)
#define REDUCTION(name, value) {#name, "dab", true}, {#name "_step", "dab", true},
#define FUNCTION(name, arguments, part, lanes, value) \
    {#name, operands_of(arguments), LaneSupport::lanes != LaneSupport::none},
#define RAY_FUNCTION(name, arguments, evaluated, channels, value) \
    {#name, operands_of(evaluated), false},
#include "core/function/library.def"
};

}  // namespace

const OpEntry& op_entry(Op op) {
    return kOps[static_cast<std::size_t>(op)];
}

}  // namespace lightwalk::function
