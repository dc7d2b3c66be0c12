#include "core/function/expression.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwalk::function {
namespace {

Expr node(ExprKind kind, Expr a, Expr b, const SourceLocation& where) {
    Expr e;
    e.kind = kind;
    e.kids.reserve(2);
    e.kids.push_back(std::move(a));
    e.kids.push_back(std::move(b));
    measure_depth(e, where);
    return e;
}

/// a op b for the operators whose nodes are lists. A list on the left takes b in: (a+b)+c and the
/// list a, b, c are evaluated alike.
Expr list_node(ExprKind kind, Expr a, Expr b, const SourceLocation& where) {
    if (a.kind != kind) return node(kind, std::move(a), std::move(b), where);
    a.depth = std::max(a.depth, b.depth + 1);
    if (a.depth > kMaxExprDepth) measure_depth(a, where);
    a.kids.push_back(std::move(b));
    return a;
}

/// Append the operands of `e`, and of its operands of the same kind, in order.
void collect(ExprKind kind, std::vector<Expr>& operands, std::vector<Expr>& list) {
    for (Expr& operand : operands) {
        if (operand.kind == kind) {
            collect(kind, operand.kids, list);
        } else {
            list.push_back(std::move(operand));
        }
    }
}

void flatten_list(Expr& e) {
    std::vector<Expr> list;
    collect(e.kind, e.kids, list);
    const auto is_number = [](const Expr& kid) { return kid.is_number(); };
    const auto first = std::find_if(list.begin(), list.end(), is_number);
    if (first != list.end()) {
        for (auto it = first + 1; it != list.end(); ++it) {
            if (!it->is_number()) continue;
            first->value =
                e.kind == ExprKind::sum ? first->value + it->value : first->value * it->value;
        }
        list.erase(std::remove_if(first + 1, list.end(), is_number), list.end());
    }
    if (list.size() == 1) {
        Expr only = std::move(list.front());
        e = std::move(only);
        return;
    }
    e.kids = std::move(list);
}

}  // namespace

Expr make_number(double value) {
    Expr e;
    e.value = value;
    return e;
}

void measure_depth(Expr& e, const SourceLocation& where) {
    e.depth = 1;
    for (const Expr& kid : e.kids) e.depth = std::max(e.depth, kid.depth + 1);
    if (e.depth > kMaxExprDepth) {
        throw InputError(where, "expression too complicated: operations nest more than " +
                                    std::to_string(kMaxExprDepth) + " deep");
    }
}

Expr make_negation(Expr e, const SourceLocation& where) {
    if (e.is_number()) return make_number(-e.value);
    if (e.kind == ExprKind::negation) {
        Expr inner = std::move(e.kids.front());
        return inner;
    }
    Expr result;
    result.kind = ExprKind::negation;
    result.kids.push_back(std::move(e));
    measure_depth(result, where);
    return result;
}

Expr make_sum(Expr a, Expr b, const SourceLocation& where) {
    if (a.is_number() && b.is_number()) return make_number(a.value + b.value);
    return list_node(ExprKind::sum, std::move(a), std::move(b), where);
}

Expr make_difference(Expr a, Expr b, const SourceLocation& where) {
    if (a.is_number() && b.is_number()) return make_number(a.value - b.value);
    if (b.is_number()) return list_node(ExprKind::sum, std::move(a), make_number(-b.value), where);
    return node(ExprKind::difference, std::move(a), std::move(b), where);
}

Expr make_product(Expr a, Expr b, const SourceLocation& where) {
    if (a.is_number() && b.is_number()) return make_number(a.value * b.value);
    if (a.is_number(0) || b.is_number(0)) return make_number(0);
    return list_node(ExprKind::product, std::move(a), std::move(b), where);
}

Expr make_quotient(Expr a, Expr b, const SourceLocation& where) {
    if (b.is_number(0)) throw InputError(where, "divide by zero constant");
    if (a.is_number() && b.is_number()) return make_number(a.value / b.value);
    if (a.is_number(0)) return make_number(0);
    if (b.is_number()) {
        return list_node(ExprKind::product, std::move(a), make_number(1.0 / b.value), where);
    }
    return node(ExprKind::quotient, std::move(a), std::move(b), where);
}

Expr make_power(Expr base, Expr exponent, const SourceLocation& where) {
    if (base.is_number() && exponent.is_number()) {
        const double v = std::pow(base.value, exponent.value);
        if (!std::isfinite(v)) throw InputError(where, "bad constant expression: illegal power");
        return make_number(v);
    }
    if (base.is_number(0)) return make_number(0);
    if (exponent.is_number(0) || base.is_number(1)) return make_number(1);
    if (exponent.is_number(1)) return base;
    return node(ExprKind::power, std::move(base), std::move(exponent), where);
}

void flatten(Expr& e) {
    if (e.kind == ExprKind::sum || e.kind == ExprKind::product) flatten_list(e);
    for (Expr& kid : e.kids) flatten(kid);
}

}  // namespace lightwalk::function
