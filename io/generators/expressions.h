#pragma once
// The function-language arguments of gensurf, genrev and genworm.
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/function/environment.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"

namespace lightwalk {

/// Functions of a generator's parameters, compiled. Numeric errors give 0, as the language says.
class CompiledFunctions {
  public:
    explicit CompiledFunctions(Program program);
    CompiledFunctions(const CompiledFunctions&) = delete;
    CompiledFunctions& operator=(const CompiledFunctions&) = delete;

    /// Value of function `index` of those that were compiled. Throws InputError for undefined
    /// names.
    [[nodiscard]] double operator()(std::size_t index, std::span<const double> arguments);
    [[nodiscard]] std::uint64_t numeric_errors() const { return state_.warnings; }

  private:
    Program program_;
    EvalState state_;
    ChannelValues channels_{};
};

/// What -e and -f define, and the expressions that use it.
class GeneratorExpressions {
  public:
    explicit GeneratorExpressions(GeneratorContext& context) : context_(context) {}

    /// Take the next option when it is -e or -f.
    bool accept_option(GeneratorWords& words);
    /// Value of an expression, rounded to the nearest whole number, from 1 to `most`. Call it when
    /// all definitions are made; so too the following ones.
    [[nodiscard]] std::size_t count(const GeneratorWords& words, const std::string& text,
                                    const std::string& what, std::size_t most) const;
    /// Define name(parameters) = body.
    void define_function(const std::string& program, const std::string& name,
                         const std::string& parameters, const std::string& body);
    /// Number of parameters of the function `name`; 0 when there is none.
    [[nodiscard]] int parameters(const std::string& name) const;
    /// Functions, by name, each called with `parameters` arguments.
    [[nodiscard]] Program compile_program(const std::string& program,
                                          std::span<const std::string> names, int parameters) const;
    /// Warn when expressions had numeric errors.
    void report(const std::string& program, const CompiledFunctions& functions) const;

  private:
    GeneratorContext& context_;
    FunctionEnvironment environment_{FunctionEnvironment::Library::generator};
};

}  // namespace lightwalk
