// Evaluation of programs.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/function/code.h"
#include "core/function/library.h"
#include "core/function/library_values.h"
#include "core/function/program.h"

namespace lightwalk {
namespace function {
namespace {

/// Recursion of a function file that does not end is an error long before memory is full.
constexpr std::size_t kMostReturns = 200000;
constexpr std::size_t kMostCells = std::size_t{1} << 21;

struct Position {
    const Instruction* next;
    std::uint32_t frame;
};

[[noreturn]] void limit_exceeded(const Program::Code& code, const char* what) {
    throw InputError(code.where, std::string("function file: ") + what);
}

void push_return(const Program::Code& code, EvalState& state, const Instruction* from,
                 std::uint32_t frame, std::uint32_t cell) {
    if (state.returns.size() >= kMostReturns) limit_exceeded(code, "recursion is too deep");
    state.returns.push_back(
        {static_cast<std::uint32_t>(from - code.instructions.data()) + 1, frame, cell});
}

/// Run the block at `entry` in `frame`, for the value of `cell`. Until then the cell is 0, which is
/// the value of a variable that refers to itself.
Position compute_cell(const Program::Code& code, EvalState& state, const Instruction* from,
                      std::uint32_t caller, std::uint32_t frame, std::uint32_t cell,
                      std::uint32_t entry) {
    push_return(code, state, from, caller, cell);
    state.valid[cell] = 1;
    state.values[cell] = 0;
    return {code.instructions.data() + entry, frame};
}

/// A parameter that is not valid yet holds its closure: the block to run, and the caller's frame.
double pack_closure(std::uint32_t entry, std::uint32_t frame) {
    return std::bit_cast<double>((std::uint64_t{entry} << 32) | frame);
}

Position force_parameter(const Program::Code& code, EvalState& state, const Instruction* from,
                         std::uint32_t frame) {
    const std::uint32_t cell = frame + from->dst;
    if (state.valid[cell]) return {from + 1, frame};
    const auto thunk = std::bit_cast<std::uint64_t>(state.values[cell]);
    return compute_cell(code, state, from, frame, static_cast<std::uint32_t>(thunk), cell,
                        static_cast<std::uint32_t>(thunk >> 32));
}

/// Enter a function: its frame begins at `base`.
Position enter_call(const Program::Code& code, EvalState& state, const Instruction* from,
                    std::uint32_t frame, std::uint32_t base) {
    const FunctionCode& function = code.functions[from->a];
    state.operations += function.cost;
    if (state.operations > kMostOperations) limit_exceeded(code, "evaluation takes too long");
    push_return(code, state, from, frame, frame + from->dst);
    const std::size_t end = std::size_t{base} + function.cells;
    if (end > kMostCells) limit_exceeded(code, "recursion is too deep");
    if (end > state.values.size()) {
        state.values.resize(std::max(end, state.values.size() * 2));
        state.valid.resize(state.values.size());
    }
    std::fill_n(state.valid.begin() + base, function.cached, std::uint8_t{0});
    for (std::uint32_t i = 0; i < function.parameters; ++i) {
        const Argument& argument = code.arguments[from->b + i];
        state.values[base + i] = argument.is_value ? state.values[frame + argument.at]
                                                   : pack_closure(argument.at, frame);
        state.valid[base + i] = argument.is_value;
    }
    return {code.instructions.data() + function.entry, base};
}

/// The value of a call whose argument is one of those that are known; else null.
const double* known_value(const Program::Code& code, const Instruction& call, const double* cells) {
    const FunctionCode& function = code.functions[call.a];
    if (function.known == 0) return nullptr;
    const Argument& argument = code.arguments[call.b];
    if (!argument.is_value) return nullptr;
    const double x = cells[argument.at];
    if (!(x >= 0 && x < function.known) || std::signbit(x)) return nullptr;
    const auto i = static_cast<std::uint32_t>(x);
    return static_cast<double>(i) == x ? &code.known[function.first_known + i] : nullptr;
}

Position return_to_caller(const Program::Code& code, EvalState& state, double value) {
    const EvalState::Return back = state.returns.back();
    state.returns.pop_back();
    state.values[back.cell] = value;
    state.valid[back.cell] = 1;
    return {code.instructions.data() + back.instruction, back.frame};
}

constexpr unsigned kDomain = static_cast<unsigned>(EvalError::domain);
constexpr unsigned kRange = static_cast<unsigned>(EvalError::range);

/// One evaluation: an interpreter loop, whose state is kept in registers.
class Machine {
  public:
    Machine(const Program::Code& code, EvalState& state, std::uint32_t entry)
        : code_(code),
          state_(state),
          i_(code.instructions.data() + entry),
          cells_(state.values.data()),
          top_(code.cells),
          error_(static_cast<unsigned>(state.error)) {
        state.returns.clear();
    }
    double run();

  private:
    [[nodiscard]] double a() const { return cells_[i_->a]; }
    [[nodiscard]] double b() const { return cells_[i_->b]; }
    [[nodiscard]] double c() const { return cells_[i_->c]; }
    void plain(double v) {
        cells_[i_->dst] = v;
        ++i_;
    }
    /// The end of a library function: a set flag or a result that is not finite makes it 0.
    [[gnu::always_inline]] double tested(double v) {
        error_ &= i_->error_mask;
        if (error_ == 0 && std::abs(v) <= std::numeric_limits<double>::max()) [[likely]]
            return v;
        if (error_ == 0) error_ = std::isnan(v) ? kDomain : kRange;
        ++state_.warnings;
        return 0;
    }
    [[gnu::always_inline]] void checked(double v) { plain(tested(v)); }
    double zero_divisor() {
        error_ = kRange;
        ++state_.warnings;
        return 0;
    }
    void clear_error_once(std::uint8_t& valid) {
        if (!valid) error_ = 0;
        valid = 1;
        ++i_;
    }
    void jump_unless(bool stay, std::uint32_t target) {
        i_ = stay ? i_ + 1 : code_.instructions.data() + target;
    }
    void guard_divisor() {
        if (a() == 0) {
            cells_[i_->dst] = zero_divisor();
            i_ = code_.instructions.data() + i_->b;
        } else {
            ++i_;
        }
    }
    void choose() {
        const int k = selected_case(a(), static_cast<int>(i_->c));
        if (k < 0) {
            error_ = kDomain;
            cells_[i_->dst] = 0;
        }
        const std::uint32_t target = k < 0 ? i_->c + 1 : static_cast<std::uint32_t>(k);
        i_ = code_.instructions.data() + code_.targets[i_->b + target];
    }
    [[gnu::always_inline]] void go_to(const Position& to) {
        i_ = to.next;
        frame_ = to.frame;
        cells_ = state_.values.data() + frame_;
    }
    [[gnu::always_inline]] void call() {
        const double* const known = error_ == 0 ? known_value(code_, *i_, cells_) : nullptr;
        if (known) {
            state_.valid[frame_ + i_->dst] = 1;
            return plain(*known);
        }
        const std::uint32_t cells = code_.functions[i_->a].cells;
        go_to(enter_call(code_, state_, i_, frame_, top_));
        top_ = frame_ + cells;
    }
    [[gnu::always_inline]] void ensure(std::uint32_t of_frame) {
        if (state_.valid[of_frame + i_->dst]) {
            ++i_;
        } else {
            go_to(compute_cell(code_, state_, i_, frame_, of_frame, of_frame + i_->dst, i_->a));
        }
    }

    const Program::Code& code_;
    EvalState& state_;
    const Instruction* i_;     ///< the present instruction
    double* cells_;            ///< of the present frame
    std::uint32_t frame_ = 0;  ///< index of its first cell
    std::uint32_t top_;        ///< where the next frame will begin
    unsigned error_;           ///< EvalError
};

[[gnu::always_inline]] inline double Machine::run() {
    for (;;) {
        // A line an instruction.
        // clang-format off
        switch (i_->op) {
            case Op::move: plain(a()); break;
            case Op::load_global: plain(state_.values[i_->a]); break;
            case Op::negate: plain(-a()); break;
            case Op::add: plain((0.0 + a()) + b()); break;
            case Op::add3: plain(((0.0 + a()) + b()) + c()); break;
            case Op::subtract: plain(a() - b()); break;
            case Op::multiply: plain(a() * b()); break;
            case Op::multiply3: plain((a() * b()) * c()); break;
            case Op::add_product: plain((0.0 + c()) + a() * b()); break;
            case Op::subtract_product: plain(c() - a() * b()); break;
            case Op::divide: plain(a() / b()); break;
            case Op::divide_tested: plain(b() == 0 ? zero_divisor() : a() / b()); break;
            case Op::guard_divisor: guard_divisor(); break;
            case Op::half_power: checked(half_power(a(), static_cast<std::int32_t>(i_->b))); break;
            case Op::power: checked(std::pow(a(), b())); break;
            case Op::modulo: plain(a() - tested(std::floor(a() / b())) * b()); break;
            case Op::fraction: plain(a() - tested(std::floor(a()))); break;
            case Op::absolute: checked(-a() > a() ? -a() : a()); break;
            case Op::check: checked(a()); break;
            case Op::conditional_move: checked(a() > 0 ? b() : c()); break;
            case Op::clear_error: error_ = 0; ++i_; break;
            case Op::clear_error_once: clear_error_once(state_.valid[frame_ + i_->dst]); break;
            case Op::clear_error_once_global: clear_error_once(state_.valid[i_->dst]); break;
            case Op::invalidate: state_.valid[frame_ + i_->dst] = 0; ++i_; break;
            case Op::jump: jump_unless(false, i_->a); break;
            case Op::jump_unless_positive: jump_unless(a() > 0, i_->b); break;
            case Op::jump_unless_above: jump_unless(a() - c() > 0, i_->b); break;
            case Op::jump_table: choose(); break;
            case Op::force: ensure(frame_); break;
            case Op::force_global: ensure(0); break;
            case Op::force_parameter: go_to(force_parameter(code_, state_, i_, frame_)); break;
            case Op::call: call(); break;
            case Op::return_block: go_to(return_to_caller(code_, state_, a())); break;
            case Op::return_call: top_ = frame_; go_to(return_to_caller(code_, state_, a())); break;
            case Op::halt: state_.error = static_cast<EvalError>(error_); return a();
            case Op::fatal: throw InputError(code_.where, code_.messages[i_->a]);
#define FUNCTION(name, ...) case Op::name: checked(library_value<LibraryFunction::name>(a(), b(), c(), state_)); break;
#define REDUCTION(name, ...) FUNCTION(name) case Op::name##_step: plain(library_value<LibraryFunction::name>(a(), b(), 0, state_)); break;
#define RAY_FUNCTION(name, ...) case Op::name: checked(ray_value<LibraryFunction::name>(a(), b(), c(), code_, state_)); break;
#define SPECIAL_FORM(...)
#include "core/function/library.def"
        }
        // clang-format on
    }
}

double run(const Program::Code& code, std::uint32_t entry, EvalState& state) {
    return Machine(code, state, entry).run();
}

}  // namespace
}  // namespace function

std::size_t Program::outputs() const {
    return code_ ? code_->outputs.size() : 0;
}
bool Program::can_throw() const {
    return code_ && (!code_->messages.empty() || !code_->functions.empty());
}
ChannelMask Program::channels() const {
    return code_ ? code_->channels : 0;
}

void Program::begin(EvalState& state, const ChannelValues& channels) const {
    const Code& code = *code_;
    state.channels = &channels;
    if (state.values.size() < code.cells) {
        state.values.resize(code.cells);
        state.valid.resize(code.cells);
    }
    for (const std::uint8_t c : code.used_channels) state.values[c] = channels[c];
    std::copy(code.constants.begin(), code.constants.end(), state.values.begin() + kChannelCount);
    std::fill_n(state.valid.begin() + code.thunks_at, code.thunks, std::uint8_t{0});
    state.operations = 0;
    state.prism.valid = false;
}

double Program::evaluate(std::size_t output, EvalState& state) const {
    return function::run(*code_, code_->outputs[output].entry, state);
}

double Program::call(std::size_t output, std::span<const double> arguments,
                     EvalState& state) const {
    std::copy(arguments.begin(), arguments.end(), state.values.begin() + code_->inputs_at);
    return function::run(*code_, code_->outputs[output].entry, state);
}

const double* Program::constant(std::size_t output) const {
    const function::OutputCode& code = code_->outputs[output];
    return code.is_constant ? &code.value : nullptr;
}

}  // namespace lightwalk
