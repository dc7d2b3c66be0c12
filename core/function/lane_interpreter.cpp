// SIMD evaluation of a program for several rays. It also hides latencies: most operations depend on
// the preceding one, those of other rays do not.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

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

/// The mask of lanes for which a predicate holds.
template <class F>
[[gnu::always_inline]] inline LaneMask which(const F& holds, const Lanes& x) {
    LaneMask mask = 0;
    for (std::size_t k = 0; k < kLanes; ++k) mask |= (holds(x.value[k]) ? 1U : 0U) << k;
    return mask;
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

/// One evaluation of all lanes. At a branch only lanes that take the same way as the first
/// continue; lanes with an error stop, so that the error flag is always clear. Operations are those
/// of the interpreter for one ray, to the bit.
class LaneMachine {
  public:
    LaneMachine(const Program::Code& code, EvalState& state, std::uint32_t entry, std::size_t used)
        : code_(code),
          state_(state),
          i_(code.instructions.data() + entry),
          cells_(state.lanes.data()),
          going_((LaneMask{1} << used) - 1) {}
    [[nodiscard]] LaneValues run();

  private:
    [[nodiscard]] const Lanes& a() const { return cells_[i_->a]; }
    [[nodiscard]] const Lanes& b() const { return cells_[i_->b]; }
    [[nodiscard]] const Lanes& c() const { return cells_[i_->c]; }
    void plain(const Lanes& v) {
        cells_[i_->dst] = v;
        ++i_;
    }
    /// Records lanes whose value is not finite; tested at the end.
    [[nodiscard]] Lanes tested(const Lanes& v) {
        errors_ = each([](double e, double x) { return e + x * 0; }, errors_, v);
        return v;
    }
    void checked(const Lanes& v) { plain(tested(v)); }
    [[nodiscard]] std::size_t first() const {
        return static_cast<std::size_t>(std::countr_zero(going_));
    }
    /// Evaluates an expensive function for active lanes only; the others get the value of the
    /// first.
    template <class F, class... Operands>
    void call(const F& f, const Operands&... operands) {
        const double at_first = f(operands.value[first()]...);
        Lanes result;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const bool wanted = k != first() && (going_ >> k & 1) != 0;
            result.value[k] = wanted ? f(operands.value[k]...) : at_first;
        }
        checked(result);
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
        Lanes result;
        if ((halves & 1) != 0)
            result = each(root, x);
        else
            result.value.fill(1);
        Lanes square = x;
        for (std::uint32_t k = halves >> 1; k > 0; k >>= 1) {
            if ((k & 1) != 0) result = each(multiply, result, square);
            square = each(multiply, square, square);
        }
        return n < 0 ? each(reciprocal, result) : result;
    }
    [[nodiscard]] Lanes floor_ratio() { return tested(each(floor_of, each(divide, a(), b()))); }
    [[nodiscard]] static LaneMask above(const Lanes& x, const Lanes& y) {
        return which(is_positive, each(subtract, x, y));
    }
    /// Divisors of 0 are errors. False: no lane is left.
    [[nodiscard]] bool divides(const Lanes& x) {
        going_ &= ~which(is_zero, x);
        return going_ != 0;
    }
    void jump(std::uint32_t target) { i_ = code_.instructions.data() + target; }
    void jump_unless(LaneMask staying) {
        const bool stays = (staying >> first() & 1) != 0;
        going_ &= stays ? staying : ~staying;
        if (stays)
            ++i_;
        else
            jump(i_->b);
    }
    /// False: no lane is left.
    [[nodiscard]] bool choose() {
        const auto cases = static_cast<int>(i_->c);
        int chosen = -1;
        for (std::size_t k = first(); k < kLanes; ++k) {
            if ((going_ >> k & 1) == 0) continue;
            const int one = selected_case(a().value[k], cases);
            if (chosen < 0) chosen = one;
            if (one < 0 || one != chosen) going_ &= ~(LaneMask{1} << k);
        }
        if (going_ != 0) jump(code_.targets[i_->b + static_cast<std::uint32_t>(chosen)]);
        return going_ != 0;
    }

    const Program::Code& code_;
    EvalState& state_;
    const Instruction* i_;  ///< the present instruction
    Lanes* cells_;
    LaneMask going_;  ///< lanes that take this way
    Lanes errors_;    ///< not 0 where a checked result was not finite
};

LaneValues LaneMachine::run() {
    constexpr LaneValues kNone;
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
            case Op::divide_tested: if (!divides(b())) return kNone; plain(each(divide, a(), b())); break;
            case Op::guard_divisor: if (!divides(a())) return kNone; ++i_; break;
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
            case Op::jump_unless_positive: jump_unless(which(is_positive, a())); break;
            case Op::jump_unless_above: jump_unless(above(a(), c())); break;
            case Op::jump_table: if (!choose()) return kNone; break;
            case Op::halt: return {a(), going_ & which(is_zero, errors_)};
#define FUNCTION(name, arguments, part, lanes, value) case Op::name: if (!library<LibraryFunction::name, LaneSupport::lanes>()) return kNone; break;
#define REDUCTION(name, value) FUNCTION(name, 2, core, vector, value) case Op::name##_step: plain(vector_value<LibraryFunction::name>()); break;
#include "core/function/library.def"
            default: return kNone;  // OpEntry::lanes is false
        }
        // clang-format on
    }
}

}  // namespace

}  // namespace function

bool Program::has_lanes() const {
    return code_ && code_->has_lanes;
}

namespace {

void load_constants(const Program::Code& code, EvalState& state) {
    if (state.lanes.size() < code.cells) state.lanes.resize(code.cells);
    Lanes* constant = state.lanes.data() + kChannelCount;
    for (const double value : code.constants) (constant++)->value.fill(value);
}

/// Evaluates 1 to kLanes rays, given by their numbers; unused lanes repeat the first ray.
LaneValues run_lanes(const Program::Code& code, std::size_t output,
                     std::span<const ChannelValues> rays, std::span<const std::uint32_t> numbers,
                     EvalState& state) {
    std::array<const ChannelValues*, kLanes> lane{};
    for (std::size_t k = 0; k < kLanes; ++k) lane[k] = &rays[numbers[k < numbers.size() ? k : 0]];
    for (const std::uint8_t c : code.used_channels) {
        for (std::size_t k = 0; k < kLanes; ++k) state.lanes[c].value[k] = (*lane[k])[c];
    }
    const std::uint32_t entry = code.outputs[output].entry;
    return function::LaneMachine(code, state, entry, numbers.size()).run();
}

}  // namespace

LaneValues Program::evaluate_lanes(std::size_t output, std::span<const ChannelValues> rays,
                                   EvalState& state) const {
    std::array<std::uint32_t, kLanes> numbers{};
    std::iota(numbers.begin(), numbers.end(), 0U);
    load_constants(*code_, state);
    return run_lanes(*code_, output, rays, std::span(numbers).first(rays.size()), state);
}

void Program::evaluate_all(std::size_t output, std::span<const ChannelValues> rays,
                           std::span<std::optional<double>> values, EvalState& state) const {
    load_constants(*code_, state);
    std::vector<std::uint32_t>& queue = state.lane_queue;
    queue.resize(rays.size());
    std::iota(queue.begin(), queue.end(), 0U);
    for (std::size_t next = 0; next < queue.size();) {
        std::array<std::uint32_t, kLanes> group{};
        const std::size_t size = std::min(kLanes, queue.size() - next);
        std::copy_n(queue.begin() + static_cast<std::ptrdiff_t>(next), size, group.begin());
        next += size;
        const LaneValues found =
            run_lanes(*code_, output, rays, std::span(group).first(size), state);
        for (std::size_t k = 0; k < size; ++k) {
            if (found.has(k))
                values[group[k]] = found.lanes.value[k];
            else if (k == 0)
                values[group[k]] = std::nullopt;
            else
                queue.push_back(group[k]);  // evaluated again with other rays that took another way
        }
    }
}

}  // namespace lightwalk
