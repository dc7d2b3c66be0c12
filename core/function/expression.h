#pragma once
// Expressions of the function language as parsed, with the rewrites that the language prescribes.
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"

namespace lightwalk::function {

using SymbolId = std::uint32_t;
inline constexpr SymbolId kNoSymbol = 0xffffffffu;

enum class ExprKind : std::uint8_t {
    number,
    channel,    ///< $index
    parameter,  ///< the index-th parameter of the function being defined
    variable,   ///< symbol `index`, spelled `name`
    sum,        ///< sum of all kids, starting from 0, left to right
    product,    ///< product of all kids, starting from 1, left to right
    difference,
    quotient,
    power,
    negation,
    call,            ///< of symbol `index`, spelled `name`
    call_parameter,  ///< call of the function that the index-th parameter names
};

/// Largest depth of an expression tree: it bounds the recursion of functions on trees.
inline constexpr std::uint32_t kMaxExprDepth = 800;

struct Expr {
    ExprKind kind = ExprKind::number;
    std::uint32_t index = 0;
    std::uint32_t depth = 1;
    double value = 0;
    std::string name;
    std::vector<Expr> kids;

    [[nodiscard]] bool is_number() const { return kind == ExprKind::number; }
    [[nodiscard]] bool is_number(double v) const { return is_number() && value == v; }
};

[[nodiscard]] Expr make_number(double value);

// Build an operator node from its operands, folding constants as each operator is recognised. These
// rewrites change rounding and hide errors, so they are part of the language: E - 2 is E + (-2),
// E / 3 is E * (1/3), E * 0 is 0, E ^ 1 is E, ... They throw InputError at `where` for a division
// by the constant zero, a constant power without a finite value, and too deep a tree.
[[nodiscard]] Expr make_negation(Expr e, const SourceLocation& where);
[[nodiscard]] Expr make_sum(Expr a, Expr b, const SourceLocation& where);
[[nodiscard]] Expr make_difference(Expr a, Expr b, const SourceLocation& where);
[[nodiscard]] Expr make_product(Expr a, Expr b, const SourceLocation& where);
[[nodiscard]] Expr make_quotient(Expr a, Expr b, const SourceLocation& where);
[[nodiscard]] Expr make_power(Expr base, Expr exponent, const SourceLocation& where);

/// Set `e.depth` from its kids; throws InputError when it is too deep.
void measure_depth(Expr& e, const SourceLocation& where);

/// Merge nested sums and nested products into lists and add up the numbers in each list, as is done
/// with every definition of a function file once it is complete.
void flatten(Expr& e);

}  // namespace lightwalk::function
