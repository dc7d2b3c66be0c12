#include "core/function/known_values.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lightwalk::function {
namespace {

constexpr std::uint32_t kMostKnown = 256;    ///< values of a function
constexpr std::uint64_t kMostWork = 200000;  ///< instructions for all values of a program

std::span<const Instruction> body(const Program::Code& code, const FunctionCode& function) {
    return std::span(code.instructions).subspan(function.entry, function.cost);
}

/// Whether an instruction of a function depends on its call alone; calls are not looked into.
bool depends_on_call(const Program::Code& code, const Instruction& i) {
    switch (i.op) {
        case Op::load_global:
            return i.a >= kChannelCount && i.a < code.inputs_at;  // a constant
        case Op::force_global:
        case Op::clear_error_once_global:
        case Op::fatal:
#define ANY_FUNCTION(name)
#define FUNCTION(...)
#define REDUCTION(...)
#define SPECIAL_FORM(...)
#define RAY_FUNCTION(name, ...) case Op::name:
#include "core/function/library.def"
            return false;
        default:
            return true;
    }
}

/// Functions that depend on their arguments alone.
std::vector<char> pure_functions(const Program::Code& code) {
    std::vector<char> pure(code.functions.size());
    for (std::size_t f = 0; f < pure.size(); ++f) {
        pure[f] = code.functions[f].cost > 0 &&
                  std::ranges::all_of(body(code, code.functions[f]), [&](const Instruction& i) {
                      return depends_on_call(code, i);
                  });
    }
    // What calls another kind is of that kind.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t f = 0; f < pure.size(); ++f) {
            if (!pure[f]) continue;
            pure[f] = std::ranges::all_of(body(code, code.functions[f]), [&](const Instruction& i) {
                return i.op != Op::call || pure[i.a];
            });
            changed = changed || !pure[f];
        }
    }
    return pure;
}

/// Calls functions of a program that is not complete: an output and an input more for its lifetime.
class Caller {
  public:
    explicit Caller(Program::Code& code)
        : code_(code),
          program_(std::shared_ptr<const Program::Code>(std::shared_ptr<void>(), &code)),
          argument_(code.cells) {
        code_.cells += 2;
        code_.arguments.push_back({true, argument_});
        code_.outputs.push_back({static_cast<std::uint32_t>(code_.instructions.size())});
        Instruction call{Op::call}, halt{Op::halt};
        call.dst = halt.a = argument_ + 1;
        call.b = static_cast<std::uint32_t>(code_.arguments.size() - 1);
        code_.instructions.insert(code_.instructions.end(), {call, halt});
        program_.begin(state_, channels_);
        state_.operations = kMostOperations - kMostWork;
    }
    ~Caller() {
        code_.instructions.resize(code_.instructions.size() - 2);
        code_.outputs.pop_back();
        code_.arguments.pop_back();
        code_.cells -= 2;
    }
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;

    /// The first values of function f, until one meets an error.
    void remember(std::uint32_t f) {
        code_.instructions[code_.instructions.size() - 2].a = f;
        FunctionCode& function = code_.functions[f];
        function.first_known = static_cast<std::uint32_t>(code_.known.size());
        while (function.known < kMostKnown) {
            state_.clear_error();
            state_.warnings = 0;
            state_.values[argument_] = function.known;
            const double value = program_.evaluate(code_.outputs.size() - 1, state_);
            if (state_.warnings > 0 || state_.error != EvalError::none) return;
            code_.known.push_back(value);
            ++function.known;
        }
    }

  private:
    Program::Code& code_;
    Program program_;  ///< does not own it
    std::uint32_t argument_;
    ChannelValues channels_{};
    EvalState state_;
};

}  // namespace

void remember_values(Program::Code& code) {
    const std::vector<char> pure = pure_functions(code);
    std::optional<Caller> caller;
    for (std::uint32_t f = 0; f < pure.size(); ++f) {
        const FunctionCode& function = code.functions[f];
        if (!pure[f] || function.parameters != 1) continue;
        if (std::ranges::count(body(code, function), Op::call, &Instruction::op) == 0) continue;
        if (!caller) caller.emplace(code);
        try {
            caller->remember(f);
        } catch (const InputError&) {
            // Recursion that does not end, or for long: an error where the value is needed.
        }
    }
}

}  // namespace lightwalk::function
