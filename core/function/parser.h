#pragma once
// Parser: from text to expressions and definitions, with constant folding.
#include <string>
#include <string_view>

#include "core/function/expression.h"
#include "core/function/lexer.h"
#include "core/function/symbols.h"
#include "core/math/function_ref.h"

namespace lightwalk::function {

/// The value of a constant variable or call, which must be known while parsing. Throws InputError
/// when it has none.
using ConstantEvaluator = FunctionRef<double(const Expr& e, const SourceLocation& where)>;

/// The scope in which a parser resolves names.
struct Scope {
    const SymbolTable& symbols;
    SymbolTable* writable =
        nullptr;  ///< where references and definitions go; null: nothing is entered
    std::string_view context;
    ConstantEvaluator evaluate;
};

/// Parse one expression that is all of `text`. Throws InputError.
[[nodiscard]] Expr parse_expression(std::string_view text, const SourceLocation& where,
                                    const Scope& scope);

/// Parse definitions and enter each into the table as soon as it is complete, flattened if `flat`.
/// Throws InputError; definitions before the error stay.
void parse_definitions(std::string_view text, const SourceLocation& where, const Scope& scope,
                       bool flat);

}  // namespace lightwalk::function
