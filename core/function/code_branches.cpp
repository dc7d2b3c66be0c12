// Code of if() and select().
#include <cmath>
#include <utility>

#include "core/function/code_generator.h"

namespace lightwalk::function {

/// Whether a branch ends with the language's test itself, or cannot fail it.
bool CodeGenerator::is_already_checked(NodeId id) const {
    const Node& n = graph_.nodes[id];
    switch (n.kind) {
        case NodeKind::library:
        case NodeKind::power:
        case NodeKind::conditional:
        case NodeKind::choice:
        case NodeKind::check:
        case NodeKind::fatal:
            return true;
        case NodeKind::constant:
            return (error_clear_ || n.clears) && std::isfinite(n.value);
        default:
            return false;
    }
}

/// Jump that is taken when the condition does not hold.
std::uint32_t CodeGenerator::jump_unless(NodeId condition) {
    const Node& n = graph_.nodes[condition];
    if (n.kind == NodeKind::difference) {
        const Cell x = node(n.kids[0]);
        const Cell y = node(n.kids[1]);
        return emit(Op::jump_unless_above, 0, x, 0, y);
    }
    return emit(Op::jump_unless_positive, 0, node(condition));
}

CodeGenerator::Cell CodeGenerator::conditional(const Node& n, Cell into) {
    const Cell first_free = next_cell_;
    if (is_in_cell(n.kids[1]) && is_in_cell(n.kids[2])) {
        const std::uint8_t error_mask = begin_checked(std::span(n.kids).first(1));
        const Cell c = node(n.kids[0]);
        const Cell yes = node(n.kids[1]);
        const Cell no = node(n.kids[2]);
        next_cell_ = first_free;
        const Cell d = result(into);
        emit(Op::conditional_move, d, c, yes, no, error_mask);
        error_clear_ = false;
        return d;
    }
    clear_error();
    const Cell d = result(into);
    const Cell inner = next_cell_;
    const std::uint32_t skip = jump_unless(n.kids[0]);
    const bool clear_here = error_clear_;
    const bool checked = is_already_checked(n.kids[1]) && is_already_checked(n.kids[2]);
    const std::size_t before = available_log_.size();
    next_cell_ = inner;
    node(n.kids[1], d);
    std::vector<std::vector<std::size_t>> branches{undo_available(before)};
    const std::uint32_t over = emit(Op::jump);
    code_.instructions[skip].b = here();
    error_clear_ = clear_here;
    next_cell_ = inner;
    node(n.kids[2], d);
    branches.push_back(undo_available(before));
    code_.instructions[over].a = here();
    keep_common(std::move(branches));
    next_cell_ = inner;
    if (!checked) emit(Op::check, d, d, 0, 0, 0xff);
    error_clear_ = false;
    return d;
}

CodeGenerator::Cell CodeGenerator::choice(const Node& n, Cell into) {
    clear_error();
    const Cell d = result(into);
    const Cell inner = next_cell_;
    const Cell selector = node(n.kids[0]);
    const auto cases = static_cast<std::uint32_t>(n.kids.size() - 2);
    const auto table = static_cast<std::uint32_t>(code_.targets.size());
    code_.targets.resize(table + cases + 2);
    emit(Op::jump_table, d, selector, table, cases);
    const bool clear_here = error_clear_;
    const std::size_t before = available_log_.size();
    std::vector<std::vector<std::size_t>> branches;
    std::vector<std::uint32_t> jumps;
    for (std::uint32_t k = 0; k <= cases; ++k) {
        code_.targets[table + k] = here();
        error_clear_ = clear_here;
        next_cell_ = inner;
        node(k == 0 ? n.kids.back() : n.kids[k], d);
        branches.push_back(undo_available(before));
        jumps.push_back(emit(Op::jump));
    }
    for (const std::uint32_t jump : jumps) code_.instructions[jump].a = here();
    code_.targets[table + cases + 1] = here();  // none: the error flag is set
    next_cell_ = inner;
    emit(Op::check, d, d, 0, 0, 0xff);
    error_clear_ = false;
    return d;
}

}  // namespace lightwalk::function
