// Code of each kind of node, in the language's order of evaluation.
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "core/function/code_generator.h"

namespace lightwalk::function {
namespace {

/// The function's own instruction; special forms have none.
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

/// Of a reduction: the instruction for all pairs but the last, whose result is not checked.
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

CodeGenerator::Cell CodeGenerator::leaf(Cell cell, Cell want) {
    if (want == kAnyCell || want == cell) return cell;
    emit(Op::move, want, cell);
    return want;
}

CodeGenerator::Cell CodeGenerator::tick_cell(Cell cell, Cell want) {
    if (in_tick()) return leaf(cell, want);
    const Cell d = result(want);
    emit(Op::load_global, d, cell);
    return d;
}

CodeGenerator::Cell CodeGenerator::node(NodeId id, Cell want) {
    const Node& n = graph_.nodes[id];
    ++depth_;
    Cell cell = 0;
    switch (n.kind) {
        case NodeKind::constant:
            cell = constant(n, want);
            break;
        case NodeKind::channel:
            cell = tick_cell(n.index, want);
            break;
        case NodeKind::input:
            cell = tick_cell(code_.inputs_at + n.index, want);
            break;
        case NodeKind::lazy:
            cell = lazy(n.index, want);
            break;
        case NodeKind::parameter:
            cell = parameter(n.index, want);
            break;
        case NodeKind::sum:
            cell = sum(n, want);
            break;
        case NodeKind::product:
            cell = product(n, want);
            break;
        case NodeKind::difference:
            cell = difference(n, want);
            break;
        case NodeKind::quotient:
            cell = quotient(n, want);
            break;
        case NodeKind::negation:
            cell = negation(n, want);
            break;
        case NodeKind::power:
            cell = power(n, want);
            break;
        case NodeKind::library:
            cell = library(n, want);
            break;
        case NodeKind::conditional:
            cell = conditional(n, want);
            break;
        case NodeKind::choice:
            cell = choice(n, want);
            break;
        case NodeKind::check:
            cell = check(n, want);
            break;
        case NodeKind::call:
            cell = call(n, want);
            break;
        case NodeKind::fatal:
            emit(Op::fatal, 0, n.index);
            cell = result(want);
            break;
    }
    --depth_;
    return cell;
}

void CodeGenerator::touch_all(const Node& n) {
    if (n.clears) clear_error();
    for (const LazyId id : n.touches) touch(id);
}

CodeGenerator::Cell CodeGenerator::constant(const Node& n, Cell want) {
    touch_all(n);
    return tick_cell(constant_cells_.at(std::bit_cast<std::uint64_t>(n.value)), want);
}

CodeGenerator::Cell CodeGenerator::lazy(LazyId id, Cell want) {
    const Lazy& lazy = graph_.lazies[id];
    const Cell cell = lazy_cell(id);
    const bool from_function = lazy.of_tick() && !in_tick();
    if (!available_[id]) {
        if (needed(id)) {
            if (!block_queued_[id]) {
                block_queued_[id] = true;
                (lazy.of_tick() ? tick_blocks_ : frame_blocks_).push_back({lazy.body, 0, id});
            }
            emit(from_function ? Op::force_global : Op::force, cell, id);
            error_clear_ = false;
        } else {
            emitting_[id] = true;
            node(lazy.body, cell);
            emitting_[id] = false;
        }
        set_available(id);
    }
    return from_function ? tick_cell(cell, want) : leaf(cell, want);
}

CodeGenerator::Cell CodeGenerator::parameter(std::uint32_t index, Cell want) {
    const std::size_t mark = available_index_of_parameter(index);
    if (!available_[mark]) {
        emit(Op::force_parameter, index);
        error_clear_ = false;
        set_available(mark);
    }
    return leaf(index, want);
}

bool CodeGenerator::is_simple_product(NodeId id) const {
    const Node& n = graph_.nodes[id];
    return n.kind == NodeKind::product && n.kids.size() == 2;
}

CodeGenerator::Cell CodeGenerator::sum(const Node& n, Cell want) {
    const Cell mark = next_cell_;
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
        next_cell_ = mark;
        const Cell d = i == n.kids.size() ? result(want) : temporary();
        if (op == Op::add_product) {
            emit(op, d, x[0], x[1], total);
        } else {
            emit(op, d, total, x[0], x[1]);
        }
        total = d;
    }
    return total;
}

CodeGenerator::Cell CodeGenerator::product(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    Cell total = node(n.kids[0]);
    for (std::size_t i = 1; i < n.kids.size();) {
        const bool two = i + 1 < n.kids.size();
        const Cell x = node(n.kids[i]);
        const Cell y = two ? node(n.kids[i + 1]) : 0;
        i += two ? 2 : 1;
        next_cell_ = mark;
        const Cell d = i == n.kids.size() ? result(want) : temporary();
        emit(two ? Op::multiply3 : Op::multiply, d, total, x, y);
        total = d;
    }
    return total;
}

/// For x - floor(x/d)*d with x and d at hand: d; for x - floor(x): kNoNode.
std::optional<NodeId> CodeGenerator::remainder_divisor(const Node& n) const {
    const NodeId x = n.kids[0];
    const auto is_floor = [](const Node& f) {
        return f.kind == NodeKind::library &&
               f.index == static_cast<std::uint32_t>(LibraryFunction::floor);
    };
    if (!quiet(x)) return std::nullopt;
    const Node& second = graph_.nodes[n.kids[1]];
    if (is_floor(second) && second.kids[0] == x) return kNoNode;
    if (!is_simple_product(n.kids[1]) || !is_floor(graph_.nodes[second.kids[0]]))
        return std::nullopt;
    const Node& ratio = graph_.nodes[graph_.nodes[second.kids[0]].kids[0]];
    const NodeId d = second.kids[1];
    const bool matches =
        ratio.kind == NodeKind::quotient && ratio.kids[0] == x && ratio.kids[1] == d;
    const Node& divisor = graph_.nodes[d];
    const bool safe = divisor.kind == NodeKind::constant && divisor.value != 0 && quiet(d);
    return matches && safe ? std::optional<NodeId>(d) : std::nullopt;
}

CodeGenerator::Cell CodeGenerator::difference(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    const Cell x = node(n.kids[0]);
    if (const std::optional<NodeId> divisor = remainder_divisor(n)) {
        const bool fraction = *divisor == kNoNode;
        const Cell y = fraction ? 0 : node(*divisor);
        next_cell_ = mark;
        const Cell d = result(want);
        emit(fraction ? Op::fraction : Op::modulo, d, x, y);
        error_clear_ = false;
        return d;
    }
    if (is_simple_product(n.kids[1])) {
        const Node& factors = graph_.nodes[n.kids[1]];
        const Cell a = node(factors.kids[0]);
        const Cell b = node(factors.kids[1]);
        next_cell_ = mark;
        const Cell d = result(want);
        emit(Op::subtract_product, d, a, b, x);
        return d;
    }
    const Cell y = node(n.kids[1]);
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::subtract, d, x, y);
    return d;
}

CodeGenerator::Cell CodeGenerator::negation(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    const Cell x = node(n.kids[0]);
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::negate, d, x);
    return d;
}

CodeGenerator::Cell CodeGenerator::quotient(const Node& n, Cell want) {
    const Node& divisor = graph_.nodes[n.kids[1]];
    const bool safe = divisor.kind == NodeKind::constant && divisor.value != 0;
    const Cell mark = next_cell_;
    if (safe || quiet(n.kids[0])) {
        const Cell y = node(n.kids[1]);
        const Cell x = node(n.kids[0]);
        next_cell_ = mark;
        const Cell d = result(want);
        emit(safe ? Op::divide : Op::divide_tested, d, x, y);
        if (!safe) error_clear_ = false;
        return d;
    }
    const Cell d = result(want);  // the numerator is not evaluated when the divisor is 0
    const Cell inner = next_cell_;
    const Cell y = node(n.kids[1]);
    const std::uint32_t guard = emit(Op::guard_divisor, d, y);
    const std::size_t known = available_log_.size();
    const Cell x = node(n.kids[0]);
    emit(Op::divide, d, x, y);
    code_.instructions[guard].b = here();
    (void)undo_available(known);
    error_clear_ = false;
    next_cell_ = inner;
    return d;
}

/// Start of a library call: what `keep` its checked operation gets.
std::uint8_t CodeGenerator::begin_checked(std::span<const NodeId> arguments) {
    for (const NodeId id : arguments) {
        if (quiet(id)) continue;
        clear_error();
        return 0xff;
    }
    return 0;
}

CodeGenerator::Cell CodeGenerator::power(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    const std::uint8_t keep = begin_checked(n.kids);
    const std::optional<std::int32_t> halves = halves_of(graph_.nodes[n.kids[1]]);
    if (halves && quiet(n.kids[1])) {
        const Cell base = node(n.kids[0]);
        next_cell_ = mark;
        const Cell d = result(want);
        emit(Op::half_power, d, base, static_cast<std::uint32_t>(*halves), 0, keep);
        error_clear_ = false;
        return d;
    }
    const Cell y = node(n.kids[1]);
    const Cell x = node(n.kids[0]);
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::power, d, x, y, 0, keep);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::library(const Node& n, Cell want) {
    const auto function = static_cast<LibraryFunction>(n.index);
    if (library_entry(function).kind == LibraryKind::reduction) return reduction(n, function, want);
    const Cell mark = next_cell_;
    const std::uint8_t keep = begin_checked(n.kids);
    std::array<Cell, 3> x{};
    for (std::size_t i = 0; i < n.kids.size(); ++i) x[i] = node(n.kids[i]);
    next_cell_ = mark;
    const Cell d = result(want);
    emit(operation(function), d, x[0], x[1], x[2], keep);
    error_clear_ = false;
    return d;
}

/// The first argument with the last, then with those before it, down to the second.
CodeGenerator::Cell CodeGenerator::reduction(const Node& n, LibraryFunction f, Cell want) {
    const Cell mark = next_cell_;
    const std::uint8_t keep = begin_checked(n.kids);
    Cell total = node(n.kids[0]);
    for (std::size_t i = n.kids.size(); --i > 1;) {
        const Cell x = node(n.kids[i]);
        next_cell_ = mark;
        const Cell d = temporary();
        emit(step_operation(f), d, total, x);
        total = d;
    }
    const Node& last = graph_.nodes[n.kids.back()];
    if (f == LibraryFunction::max && n.kids.size() == 2 && last.kind == NodeKind::negation &&
        last.kids[0] == n.kids[0] && quiet(n.kids[0])) {
        next_cell_ = mark;
        const Cell d = result(want);
        emit(Op::absolute, d, total, 0, 0, keep);
        error_clear_ = false;
        return d;
    }
    if (n.kids.size() > 1) {
        const Cell x = node(n.kids[1]);
        next_cell_ = mark;
        const Cell d = result(want);
        emit(operation(f), d, total, x, 0, keep);
        error_clear_ = false;
        return d;
    }
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::check, d, total, 0, 0, keep);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::check(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    const bool calm = n.touches.empty() && quiet(n.kids[0]);
    if (!calm) clear_error();
    for (const LazyId id : n.touches) touch(id);
    const Cell x = node(n.kids[0]);
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::check, d, x, 0, 0, calm ? 0 : 0xff);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::call(const Node& n, Cell want) {
    const Cell mark = next_cell_;
    const auto first = static_cast<std::uint32_t>(code_.arguments.size());
    code_.arguments.resize(first + n.kids.size());
    for (std::uint32_t i = 0; i < n.kids.size(); ++i) {
        if (quiet(n.kids[i])) {
            const Cell x = node(n.kids[i]);
            code_.arguments[first + i] = {true, x};
        } else {
            (in_tick() ? tick_blocks_ : frame_blocks_).push_back({n.kids[i], first + i, kNoNode});
        }
    }
    next_cell_ = mark;
    const Cell d = result(want);
    emit(Op::call, d, n.index, first);
    error_clear_ = false;
    return d;
}

}  // namespace lightwalk::function
