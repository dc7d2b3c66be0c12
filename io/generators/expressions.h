#pragma once
// Expressions of the function language, as arguments of gensurf, genrev and genworm.
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/function/environment.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"

namespace lightwalk {

/// Compiled functions of a generator's parameters. A numeric error gives 0, as the language
/// prescribes.
class CompiledFunctions {
  public:
    explicit CompiledFunctions(Program program);
    CompiledFunctions(const CompiledFunctions&) = delete;
    CompiledFunctions& operator=(const CompiledFunctions&) = delete;

    /// The value of the compiled function number `index`. Throws InputError for undefined names.
    [[nodiscard]] double operator()(std::size_t index, std::span<const double> arguments);
    [[nodiscard]] std::uint64_t numeric_errors() const { return state_.warnings; }

  private:
    Program program_;
    EvalState state_;
    ChannelValues channels_{};
};

/// The definitions of -e and -f, and expressions that use them.
class GeneratorExpressions {
  public:
    explicit GeneratorExpressions(GeneratorContext& context) : context_(context) {}

    /// Read the next option if it is -e or -f; false if it is another one.
    bool accept_option(GeneratorWords& words);
    // The functions below are to be called when all definitions have been read.
    /// The value of an expression, rounded to the nearest integer, which must be from 1 to `most`.
    [[nodiscard]] std::size_t count(const GeneratorWords& words, const std::string& text,
                                    const std::string& what, std::size_t most) const;
    /// Define name(parameters) = body.
    void define_function(const std::string& program, const std::string& name,
                         const std::string& parameters, const std::string& body);
    /// The number of parameters of the function `name`; 0 when there is no such function.
    [[nodiscard]] int parameters(const std::string& name) const;
    /// Compile the functions with these names, each with `parameters` arguments.
    [[nodiscard]] Program compile_program(const std::string& program,
                                          std::span<const std::string> names, int parameters) const;
    /// Warn if evaluations of `functions` had numeric errors.
    void report(const std::string& program, const CompiledFunctions& functions) const;

  private:
    GeneratorContext& context_;
    FunctionEnvironment environment_{FunctionEnvironment::Library::generator};
};

}  // namespace lightwalk
