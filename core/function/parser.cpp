#include "core/function/parser.h"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace lightwalk::function {
namespace {

/// Deepest nesting of parentheses, arguments and exponents.
constexpr int kMaxNesting = 300;

class Parser {
  public:
    Parser(std::string_view text, const SourceLocation& where, const Scope& scope)
        : lexer_(text, where), scope_(scope) {}

    Expr whole_expression() {
        Expr e = sum();
        if (!lexer_.at_end()) lexer_.unexpected("an operator or the end");
        return e;
    }

    void definitions(bool flat) {
        while (!lexer_.at_end()) {
            if (lexer_.accept(';')) continue;
            definition(flat);
            if (!lexer_.at_end()) lexer_.expect(';', "an operator or ';'");
        }
    }

  private:
    void definition(bool flat);
    void parameter_list();
    Expr sum();
    Expr product();
    Expr power();
    Expr unary();
    Expr atom();
    Expr named();
    Expr reference(std::string name);
    Expr call(std::string name);
    void arguments(Expr& e);
    SymbolId refer(const std::string& name) const;
    [[nodiscard]] bool is_foldable(const Expr& call) const;

    Lexer lexer_;
    const Scope& scope_;
    std::vector<std::string> parameters_;
    int nesting_ = 0;
};

/// Counts a level of nesting while it lives.
class Nested {
  public:
    Nested(int& level, const SourceLocation& where) : level_(level) {
        if (level_ >= kMaxNesting) {
            throw InputError(where, "expression too complicated: it nests more than " +
                                        std::to_string(kMaxNesting) + " deep");
        }
        ++level_;
    }
    ~Nested() { --level_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;

  private:
    int& level_;
};

void Parser::parameter_list() {
    do {
        if (!lexer_.at_name()) lexer_.unexpected("the name of a parameter");
        const SourceLocation where = lexer_.where();
        parameters_.push_back(lexer_.name());
        if (parameters_.back().find('`') != std::string::npos) {
            throw InputError(where, "illegal parameter name \"" + parameters_.back() +
                                        "\", expected one without a backquote");
        }
    } while (lexer_.accept(','));
    lexer_.expect(')', "',' or ')' in a list of parameters");
}

void Parser::definition(bool flat) {
    if (lexer_.peek() == '$') {
        throw InputError(lexer_.where(), "illegal variable name: only a name can be defined");
    }
    if (!lexer_.at_name()) lexer_.unexpected("a definition");
    const std::string name = lexer_.name();
    Definition made;
    parameters_.clear();
    made.is_function = lexer_.accept('(');
    if (made.is_function) parameter_list();
    made.constant = lexer_.accept(':');
    if (!made.constant) lexer_.expect('=', "'=' or ':'");
    made.body = sum();
    made.parameters = std::move(parameters_);
    parameters_.clear();
    if (flat) flatten(made.body);
    scope_.writable->define(name, scope_.context, std::move(made));
}

Expr Parser::sum() {
    Expr e = product();
    for (;;) {
        if (lexer_.accept('+')) {
            e = make_sum(std::move(e), product(), lexer_.where());
        } else if (lexer_.accept('-')) {
            e = make_difference(std::move(e), product(), lexer_.where());
        } else {
            return e;
        }
    }
}

Expr Parser::product() {
    Expr e = power();
    for (;;) {
        if (lexer_.accept('*')) {
            e = make_product(std::move(e), power(), lexer_.where());
        } else if (lexer_.accept('/')) {
            e = make_quotient(std::move(e), power(), lexer_.where());
        } else {
            return e;
        }
    }
}

Expr Parser::power() {
    Expr base = unary();
    if (!lexer_.accept('^')) return base;
    const Nested level(nesting_, lexer_.where());
    return make_power(std::move(base), power(), lexer_.where());
}

Expr Parser::unary() {
    if (lexer_.accept('-')) return make_negation(atom(), lexer_.where());
    lexer_.accept('+');
    return atom();
}

Expr Parser::atom() {
    if (lexer_.at_number()) return make_number(lexer_.number());
    if (lexer_.at_name()) return named();
    if (lexer_.accept('$')) {
        Expr e;
        e.kind = ExprKind::channel;
        e.index = lexer_.integer();
        return e;
    }
    if (!lexer_.accept('(')) lexer_.unexpected("a number, a name or '('");
    const Nested level(nesting_, lexer_.where());
    Expr e = sum();
    lexer_.expect(')', "an operator or ')'");
    return e;
}

Expr Parser::named() {
    std::string name = lexer_.name();
    return lexer_.accept('(') ? call(std::move(name)) : reference(std::move(name));
}

SymbolId Parser::refer(const std::string& name) const {
    if (scope_.writable) return scope_.writable->refer(name, scope_.context);
    return scope_.symbols.find(name, scope_.context).value_or(kNoSymbol);
}

Expr Parser::reference(std::string name) {
    Expr e;
    const auto parameter = std::find(parameters_.begin(), parameters_.end(), name);
    if (parameter != parameters_.end()) {
        e.kind = ExprKind::parameter;
        e.index = static_cast<std::uint32_t>(parameter - parameters_.begin());
        e.name = std::move(name);
        return e;
    }
    e.kind = ExprKind::variable;
    e.index = refer(name);
    e.name = std::move(name);
    if (e.index == kNoSymbol) return e;
    const Symbol& symbol = scope_.symbols[e.index];
    if (symbol.is_variable() && symbol.definition->constant) {
        return make_number(scope_.evaluate(e, lexer_.where()));
    }
    return e;
}

void Parser::arguments(Expr& e) {
    const Nested level(nesting_, lexer_.where());
    do {
        e.kids.push_back(sum());
    } while (lexer_.accept(','));
    lexer_.expect(')', "an operator, ',' or ')'");
    measure_depth(e, lexer_.where());
}

Expr Parser::call(std::string name) {
    Expr e;
    const auto parameter = std::find(parameters_.begin(), parameters_.end(), name);
    const bool is_parameter = parameter != parameters_.end();
    e.kind = is_parameter ? ExprKind::call_parameter : ExprKind::call;
    e.index =
        is_parameter ? static_cast<std::uint32_t>(parameter - parameters_.begin()) : refer(name);
    e.name = std::move(name);
    arguments(e);
    if (is_foldable(e)) return make_number(scope_.evaluate(e, lexer_.where()));
    return e;
}

bool Parser::is_foldable(const Expr& e) const {
    if (e.kind != ExprKind::call || e.index == kNoSymbol) return false;
    if (!scope_.symbols[e.index].is_constant_function()) return false;
    return std::all_of(e.kids.begin(), e.kids.end(), [this](const Expr& kid) {
        if (kid.is_number()) return true;
        return kid.kind == ExprKind::variable && kid.index != kNoSymbol &&
               scope_.symbols[kid.index].is_constant_function();
    });
}

}  // namespace

Expr parse_expression(std::string_view text, const SourceLocation& where, const Scope& scope) {
    return Parser(text, where, scope).whole_expression();
}

void parse_definitions(std::string_view text, const SourceLocation& where, const Scope& scope,
                       bool flat) {
    assert(scope.writable);
    Parser(text, where, scope).definitions(flat);
}

}  // namespace lightwalk::function
