// Evaluation of a program for several rays side by side. Most operations of a program wait for the
// one before; those of other rays fill the gaps.
#include <cmath>
#include <cstddef>

#include "core/function/code.h"
#include "core/function/library.h"
#include "core/function/library_values.h"
#include "core/function/program.h"

namespace lightwalk {
namespace function {
namespace {

template <class F, class... Operands>
[[gnu::always_inline]] inline Lanes each(const F& f, const Operands&... operands) {
    Lanes result;
    for (std::size_t k = 0; k < kLanes; ++k) result.value[k] = f(operands.value[k]...);
    return result;
}

template <class F>
[[gnu::always_inline]] inline std::size_t count(const F& holds, const Lanes& x) {
    std::size_t n = 0;
    for (const double v : x.value) n += holds(v) ? 1 : 0;
    return n;
}

constexpr auto is_zero = [](double x) { return x == 0; };
constexpr auto is_positive = [](double x) { return x > 0; };
constexpr auto add = [](double x, double y) { return (0.0 + x) + y; };
constexpr auto add3 = [](double x, double y, double z) { return ((0.0 + x) + y) + z; };
constexpr auto subtract = [](double x, double y) { return x - y; };
constexpr auto multiply = [](double x, double y) { return x * y; };
constexpr auto multiply3 = [](double x, double y, double z) { return (x * y) * z; };
constexpr auto add_product = [](double x, double y, double z) { return (0.0 + z) + x * y; };
constexpr auto subtract_product = [](double x, double y, double z) { return z - x * y; };
constexpr auto divide = [](double x, double y) { return x / y; };
constexpr auto pick = [](double x, double y, double z) { return x > 0 ? y : z; };
constexpr auto negate = [](double x) { return -x; };
constexpr auto floor_of = [](double x) { return std::floor(x); };
constexpr auto absolute = [](double x) { return -x > x ? -x : x; };
constexpr auto reciprocal = [](double x) { return 1 / x; };
constexpr auto root = [](double x) { return std::sqrt(x); };

/// One evaluation of all lanes, as long as they take the same way and none has an error: the error
/// flag is always clear. Operations are those of the interpreter for one ray, to the bit.
class LaneMachine {
  public:
    LaneMachine(const Program::Code& code, EvalState& state, std::uint32_t entry, std::size_t used)
        : code_(code),
          state_(state),
          i_(code.instructions.data() + entry),
          cells_(state.lanes.data()),
          used_(used) {}
    [[nodiscard]] std::optional<Lanes> run();

  private:
    [[nodiscard]] const Lanes& a() const { return cells_[i_->a]; }
    [[nodiscard]] const Lanes& b() const { return cells_[i_->b]; }
    [[nodiscard]] const Lanes& c() const { return cells_[i_->c]; }
    void plain(const Lanes& v) {
        cells_[i_->dst] = v;
        ++i_;
    }
    /// Note what is not finite; halt asks.
    [[nodiscard]] Lanes tested(const Lanes& v) {
        errors_ = each([](double e, double x) { return e + x * 0; }, errors_, v);
        return v;
    }
    void checked(const Lanes& v) { plain(tested(v)); }
    /// A function that takes long: of the lanes in use only; the others are as the first. Results
    /// are put together in registers: a vector that was stored by parts is slow to load.
    template <class F, class... Operands>
    void call(const F& f, const Operands&... operands) {
        static_assert(kLanes == 4);
        const double first = f(operands.value[0]...);
        const double second = used_ > 1 ? f(operands.value[1]...) : first;
        const double third = used_ > 2 ? f(operands.value[2]...) : first;
        const double fourth = used_ > 3 ? f(operands.value[3]...) : first;
        checked({{first, second, third, fourth}});
    }
    template <LibraryFunction f>
    [[nodiscard]] Lanes vector_value() const {
        return each(
            [this](double x, double y, double z) { return library_value<f>(x, y, z, state_); }, a(),
            b(), c());
    }
    /// False: not in lanes.
    template <LibraryFunction f, LaneSupport support>
    [[nodiscard]] bool library() {
        if constexpr (support == LaneSupport::vector) {
            checked(vector_value<f>());
        } else if constexpr (support == LaneSupport::in_turn) {
            call([this](double x, double y, double z) { return library_value<f>(x, y, z, state_); },
                 a(), b(), c());
        }
        return support != LaneSupport::none;
    }
    /// As half_power of one number.
    [[nodiscard]] static Lanes half_power(const Lanes& x, std::int32_t n) {
        const auto halves = static_cast<std::uint32_t>(n < 0 ? -n : n);
        Lanes result = (halves & 1) != 0 ? each(root, x) : Lanes{{1, 1, 1, 1}};
        Lanes square = x;
        for (std::uint32_t k = halves >> 1; k > 0; k >>= 1) {
            if ((k & 1) != 0) result = each(multiply, result, square);
            square = each(multiply, square, square);
        }
        return n < 0 ? each(reciprocal, result) : result;
    }
    [[nodiscard]] Lanes floor_ratio() { return tested(each(floor_of, each(divide, a(), b()))); }
    [[nodiscard]] static std::size_t count_above(const Lanes& x, const Lanes& y) {
        return count(is_positive, each(subtract, x, y));
    }
    [[nodiscard]] static bool divides(const Lanes& x) { return count(is_zero, x) == 0; }
    void jump(std::uint32_t target) { i_ = code_.instructions.data() + target; }
    /// False: some lanes stay, others jump.
    [[nodiscard]] bool jump_unless(std::size_t staying) {
        if (staying != 0 && staying != kLanes) return false;
        if (staying == 0) {
            jump(i_->b);
        } else {
            ++i_;
        }
        return true;
    }
    [[nodiscard]] bool choose() {
        const auto cases = static_cast<int>(i_->c);
        const int chosen = selected_case(a().value[0], cases);
        if (chosen < 0) return false;
        for (const double x : a().value) {
            if (selected_case(x, cases) != chosen) return false;
        }
        jump(code_.targets[i_->b + static_cast<std::uint32_t>(chosen)]);
        return true;
    }

    const Program::Code& code_;
    EvalState& state_;
    const Instruction* i_;  ///< the present instruction
    Lanes* cells_;
    std::size_t used_;  ///< lanes
    Lanes errors_;      ///< not 0 where a checked result was not finite
};

std::optional<Lanes> LaneMachine::run() {
    constexpr std::nullopt_t kDiverged = std::nullopt;
    for (;;) {
        // A line an instruction.
        // clang-format off
        switch (i_->op) {
            case Op::move: plain(a()); break;
            case Op::negate: plain(each(negate, a())); break;
            case Op::add: plain(each(add, a(), b())); break;
            case Op::add3: plain(each(add3, a(), b(), c())); break;
            case Op::subtract: plain(each(subtract, a(), b())); break;
            case Op::multiply: plain(each(multiply, a(), b())); break;
            case Op::multiply3: plain(each(multiply3, a(), b(), c())); break;
            case Op::add_product: plain(each(add_product, a(), b(), c())); break;
            case Op::subtract_product: plain(each(subtract_product, a(), b(), c())); break;
            case Op::divide: plain(each(divide, a(), b())); break;
            case Op::divide_tested: if (!divides(b())) return kDiverged; plain(each(divide, a(), b())); break;
            case Op::guard_divisor: if (!divides(a())) return kDiverged; ++i_; break;
            case Op::half_power: checked(half_power(a(), static_cast<std::int32_t>(i_->b))); break;
            case Op::power: call([](double x, double y) { return std::pow(x, y); }, a(), b()); break;
            case Op::modulo: plain(each(subtract_product, floor_ratio(), b(), a())); break;
            case Op::fraction: plain(each(subtract, a(), tested(each(floor_of, a())))); break;
            case Op::absolute: checked(each(absolute, a())); break;
            case Op::check: checked(a()); break;
            case Op::conditional_move: checked(each(pick, a(), b(), c())); break;
            case Op::clear_error:
            case Op::clear_error_once:
            case Op::clear_error_once_global: ++i_; break;
            case Op::jump: jump(i_->a); break;
            case Op::jump_unless_positive: if (!jump_unless(count(is_positive, a()))) return kDiverged; break;
            case Op::jump_unless_above: if (!jump_unless(count_above(a(), c()))) return kDiverged; break;
            case Op::jump_table: if (!choose()) return kDiverged; break;
            case Op::halt: return count(is_zero, errors_) == kLanes ? std::optional(a()) : std::nullopt;
#define FUNCTION(name, arguments, part, lanes, value) case Op::name: if (!library<LibraryFunction::name, LaneSupport::lanes>()) return kDiverged; break;
#define REDUCTION(name, value) FUNCTION(name, 2, core, vector, value) case Op::name##_step: plain(vector_value<LibraryFunction::name>()); break;
#include "core/function/library.def"
            default: return kDiverged;  // OpEntry::lanes is false
        }
        // clang-format on
    }
}

}  // namespace

}  // namespace function

bool Program::has_lanes() const {
    return code_ && code_->has_lanes;
}

std::optional<Lanes> Program::evaluate_lanes(std::size_t output,
                                             std::span<const ChannelValues> rays,
                                             EvalState& state) const {
    const Code& code = *code_;
    if (state.lanes.size() < code.cells) state.lanes.resize(code.cells);
    const auto lane = [&](std::size_t k) -> const ChannelValues& {
        return rays[k < rays.size() ? k : 0];
    };
    for (const std::uint8_t c : code.used_channels)
        state.lanes[c] = {{lane(0)[c], lane(1)[c], lane(2)[c], lane(3)[c]}};
    Lanes* constant = state.lanes.data() + kChannelCount;
    for (const double value : code.constants) (constant++)->value.fill(value);
    const std::uint32_t entry = code.outputs[output].entry;
    return function::LaneMachine(code, state, entry, rays.size()).run();
}

}  // namespace lightwalk
