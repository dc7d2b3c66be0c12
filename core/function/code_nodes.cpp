// Code of each kind of node, in the language's order of evaluation.
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "core/function/code_generator.h"

namespace lightwalk::function {
namespace {

/// The function's own instruction; if, select and the like have none.
Op operation(LibraryFunction f) {
    switch (f) {
#define SPECIAL_FORM(name, spelling, arguments)
#define ANY_FUNCTION(name)      \
    case LibraryFunction::name: \
        return Op::name;
#include "core/function/library.def"
        default:
            return Op::fatal;
    }
}

/// The instruction for the steps of a reduction except the last; its result is not checked.
Op step_operation(LibraryFunction f) {
    switch (f) {
#define REDUCTION(name, value)  \
    case LibraryFunction::name: \
        return Op::name##_step;
#include "core/function/library.def"
        default:
            return Op::fatal;
    }
}

/// Twice the exponent, where it is a constant that half_power takes.
std::optional<std::int32_t> halves_of(const Node& exponent) {
    const double halves = 2 * exponent.value;
    if (exponent.kind != NodeKind::constant || std::abs(halves) > kMostHalves ||
        halves != std::floor(halves)) {
        return std::nullopt;
    }
    return static_cast<std::int32_t>(halves);
}

}  // namespace

CodeGenerator::Cell CodeGenerator::leaf(Cell cell, Cell into) {
    if (into == kAnyCell || into == cell) return cell;
    emit(Op::move, into, cell);
    return into;
}

CodeGenerator::Cell CodeGenerator::global_cell(Cell cell, Cell into) {
    if (in_global_frame()) return leaf(cell, into);
    const Cell d = result(into);
    emit(Op::load_global, d, cell);
    return d;
}

CodeGenerator::Cell CodeGenerator::node(NodeId id, Cell into) {
    ++depth_;
    const Cell cell = node_of_kind(graph_.nodes[id], into);
    --depth_;
    return cell;
}

CodeGenerator::Cell CodeGenerator::node_of_kind(const Node& n, Cell into) {
    switch (n.kind) {
        case NodeKind::constant:
            return constant(n, into);
        case NodeKind::channel:
            return global_cell(n.index, into);
        case NodeKind::input:
            return global_cell(code_.inputs_at + n.index, into);
        case NodeKind::thunk:
            return thunk(n.index, into);
        case NodeKind::parameter:
            return parameter(n.index, into);
        case NodeKind::sum:
            return sum(n, into);
        case NodeKind::product:
            return product(n, into);
        case NodeKind::difference:
            return difference(n, into);
        case NodeKind::quotient:
            return quotient(n, into);
        case NodeKind::negation:
            return negation(n, into);
        case NodeKind::power:
            return power(n, into);
        case NodeKind::library:
            return library(n, into);
        case NodeKind::conditional:
            return conditional(n, into);
        case NodeKind::choice:
            return choice(n, into);
        case NodeKind::check:
            return check(n, into);
        case NodeKind::call:
            return call(n, into);
        case NodeKind::fatal:
            emit(Op::fatal, 0, n.index);
            return result(into);
    }
    return into;
}

void CodeGenerator::use_folded_thunks(const Node& n) {
    if (n.clears) clear_error();
    for (const ThunkId id : n.folded_thunks) use_folded_thunk(id);
}

CodeGenerator::Cell CodeGenerator::constant(const Node& n, Cell into) {
    use_folded_thunks(n);
    return global_cell(constant_cells_.at(std::bit_cast<std::uint64_t>(n.value)), into);
}

CodeGenerator::Cell CodeGenerator::thunk(ThunkId id, Cell into) {
    const Thunk& thunk = graph_.thunks[id];
    const Cell cell = thunk_cell(id);
    const bool from_function = thunk.is_global() && !in_global_frame();
    if (!available_[id]) {
        if (note_first_use(id)) {
            if (!block_queued_[id]) {
                block_queued_[id] = true;
                (thunk.is_global() ? global_blocks_ : frame_blocks_).push_back({thunk.body, 0, id});
            }
            emit(from_function ? Op::force_global : Op::force, cell, id);
            error_clear_ = false;
        } else {
            emitting_[id] = true;
            node(thunk.body, cell);
            emitting_[id] = false;
        }
        set_available(id);
    }
    return from_function ? global_cell(cell, into) : leaf(cell, into);
}

CodeGenerator::Cell CodeGenerator::parameter(std::uint32_t index, Cell into) {
    const std::size_t at = available_index_of_parameter(index);
    if (!available_[at]) {
        emit(Op::force_parameter, index);
        error_clear_ = false;
        set_available(at);
    }
    return leaf(index, into);
}

bool CodeGenerator::is_simple_product(NodeId id) const {
    const Node& n = graph_.nodes[id];
    return n.kind == NodeKind::product && n.kids.size() == 2;
}

CodeGenerator::Cell CodeGenerator::sum(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    Cell total = node(n.kids[0]);
    for (std::size_t i = 1; i < n.kids.size();) {
        std::array<Cell, 2> x{};
        Op op = Op::add;
        std::size_t used = 1;
        if (is_simple_product(n.kids[i])) {
            const Node& factors = graph_.nodes[n.kids[i]];
            op = Op::add_product;
            x = {node(factors.kids[0]), node(factors.kids[1])};
        } else if (i + 1 < n.kids.size() && !is_simple_product(n.kids[i + 1])) {
            op = Op::add3;
            used = 2;
            x[0] = node(n.kids[i]);
            x[1] = node(n.kids[i + 1]);
        } else {
            x[0] = node(n.kids[i]);
        }
        i += used;
        next_cell_ = first_free;
        const Cell d = i == n.kids.size() ? result(into) : temporary();
        if (op == Op::add_product) {
            emit(op, d, x[0], x[1], total);
        } else {
            emit(op, d, total, x[0], x[1]);
        }
        total = d;
    }
    return total;
}

CodeGenerator::Cell CodeGenerator::product(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    Cell total = node(n.kids[0]);
    for (std::size_t i = 1; i < n.kids.size();) {
        const bool two = i + 1 < n.kids.size();
        const Cell x = node(n.kids[i]);
        const Cell y = two ? node(n.kids[i + 1]) : 0;
        i += two ? 2 : 1;
        next_cell_ = first_free;
        const Cell d = i == n.kids.size() ? result(into) : temporary();
        emit(two ? Op::multiply3 : Op::multiply, d, total, x, y);
        total = d;
    }
    return total;
}

/// For x - floor(x/d)*d where x and d have no side effects: d; for x - floor(x): kNoNode.
std::optional<NodeId> CodeGenerator::remainder_divisor(const Node& n) const {
    const NodeId x = n.kids[0];
    const auto is_floor = [](const Node& f) {
        return f.kind == NodeKind::library &&
               f.index == static_cast<std::uint32_t>(LibraryFunction::floor);
    };
    if (!is_side_effect_free(x)) return std::nullopt;
    const Node& second = graph_.nodes[n.kids[1]];
    if (is_floor(second) && second.kids[0] == x) return kNoNode;
    if (!is_simple_product(n.kids[1]) || !is_floor(graph_.nodes[second.kids[0]]))
        return std::nullopt;
    const Node& ratio = graph_.nodes[graph_.nodes[second.kids[0]].kids[0]];
    const NodeId d = second.kids[1];
    const bool matches =
        ratio.kind == NodeKind::quotient && ratio.kids[0] == x && ratio.kids[1] == d;
    const Node& divisor = graph_.nodes[d];
    const bool safe =
        divisor.kind == NodeKind::constant && divisor.value != 0 && is_side_effect_free(d);
    return matches && safe ? std::optional<NodeId>(d) : std::nullopt;
}

CodeGenerator::Cell CodeGenerator::difference(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    const Cell x = node(n.kids[0]);
    if (const std::optional<NodeId> divisor = remainder_divisor(n)) {
        const bool fraction = *divisor == kNoNode;
        const Cell y = fraction ? 0 : node(*divisor);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(fraction ? Op::fraction : Op::modulo, d, x, y);
        error_clear_ = false;
        return d;
    }
    if (is_simple_product(n.kids[1])) {
        const Node& factors = graph_.nodes[n.kids[1]];
        const Cell a = node(factors.kids[0]);
        const Cell b = node(factors.kids[1]);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(Op::subtract_product, d, a, b, x);
        return d;
    }
    const Cell y = node(n.kids[1]);
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::subtract, d, x, y);
    return d;
}

CodeGenerator::Cell CodeGenerator::negation(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    const Cell x = node(n.kids[0]);
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::negate, d, x);
    return d;
}

CodeGenerator::Cell CodeGenerator::quotient(const Node& n, Cell into) {
    const Node& divisor = graph_.nodes[n.kids[1]];
    const bool safe = divisor.kind == NodeKind::constant && divisor.value != 0;
    const Cell first_free = next_cell_;
    if (safe || is_side_effect_free(n.kids[0])) {
        const Cell y = node(n.kids[1]);
        const Cell x = node(n.kids[0]);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(safe ? Op::divide : Op::divide_tested, d, x, y);
        if (!safe) error_clear_ = false;
        return d;
    }
    const Cell d = result(into);  // the numerator is not evaluated when the divisor is 0
    const Cell inner = next_cell_;
    const Cell y = node(n.kids[1]);
    const std::uint32_t guard = emit(Op::guard_divisor, d, y);
    const std::size_t before = available_log_.size();
    const Cell x = node(n.kids[0]);
    emit(Op::divide, d, x, y);
    code_.instructions[guard].b = here();
    (void)undo_available(before);
    error_clear_ = false;
    next_cell_ = inner;
    return d;
}

/// Start of a library call: the error_mask of its checked instruction.
std::uint8_t CodeGenerator::begin_checked(std::span<const NodeId> arguments) {
    for (const NodeId id : arguments) {
        if (is_side_effect_free(id)) continue;
        clear_error();
        return 0xff;
    }
    return 0;
}

CodeGenerator::Cell CodeGenerator::power(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    const std::uint8_t error_mask = begin_checked(n.kids);
    const std::optional<std::int32_t> halves = halves_of(graph_.nodes[n.kids[1]]);
    if (halves && is_side_effect_free(n.kids[1])) {
        const Cell base = node(n.kids[0]);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(Op::half_power, d, base, static_cast<std::uint32_t>(*halves), 0, error_mask);
        error_clear_ = false;
        return d;
    }
    const Cell y = node(n.kids[1]);
    const Cell x = node(n.kids[0]);
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::power, d, x, y, 0, error_mask);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::library(const Node& n, Cell into) {
    const auto function = static_cast<LibraryFunction>(n.index);
    if (library_entry(function).kind == LibraryKind::reduction) return reduction(n, function, into);
    const Cell first_free = next_cell_;
    const std::uint8_t error_mask = begin_checked(n.kids);
    std::array<Cell, 3> x{};
    for (std::size_t i = 0; i < n.kids.size(); ++i) x[i] = node(n.kids[i]);
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(operation(function), d, x[0], x[1], x[2], error_mask);
    error_clear_ = false;
    return d;
}

/// The first argument with the last, then with those before it, down to the second.
CodeGenerator::Cell CodeGenerator::reduction(const Node& n, LibraryFunction f, Cell into) {
    const Cell first_free = next_cell_;
    const std::uint8_t error_mask = begin_checked(n.kids);
    Cell total = node(n.kids[0]);
    for (std::size_t i = n.kids.size(); --i > 1;) {
        const Cell x = node(n.kids[i]);
        next_cell_ = first_free;
        const Cell d = temporary();
        emit(step_operation(f), d, total, x);
        total = d;
    }
    const Node& last = graph_.nodes[n.kids.back()];
    if (f == LibraryFunction::max && n.kids.size() == 2 && last.kind == NodeKind::negation &&
        last.kids[0] == n.kids[0] && is_side_effect_free(n.kids[0])) {
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(Op::absolute, d, total, 0, 0, error_mask);
        error_clear_ = false;
        return d;
    }
    if (n.kids.size() > 1) {
        const Cell x = node(n.kids[1]);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(operation(f), d, total, x, 0, error_mask);
        error_clear_ = false;
        return d;
    }
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::check, d, total, 0, 0, error_mask);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::check(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    const bool side_effect_free = n.folded_thunks.empty() && is_side_effect_free(n.kids[0]);
    if (!side_effect_free) clear_error();
    for (const ThunkId id : n.folded_thunks) use_folded_thunk(id);
    const Cell x = node(n.kids[0]);
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::check, d, x, 0, 0, side_effect_free ? 0 : 0xff);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::call(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    const auto first = static_cast<std::uint32_t>(code_.arguments.size());
    code_.arguments.resize(first + n.kids.size());
    for (std::uint32_t i = 0; i < n.kids.size(); ++i) {
        if (is_side_effect_free(n.kids[i])) {
            const Cell x = node(n.kids[i]);
            code_.arguments[first + i] = {true, x};
        } else {
            (in_global_frame() ? global_blocks_ : frame_blocks_)
                .push_back({n.kids[i], first + i, kNoNode});
        }
    }
    next_cell_ = first_free;
    const Cell d = result(into);
    emit(Op::call, d, n.index, first);
    error_clear_ = false;
    return d;
}

}  // namespace lightwalk::function
