#include "io/generators/expressions.h"

#include <cmath>

namespace lightwalk {
namespace {

constexpr std::size_t kMaxFunctionFileBytes = std::size_t{16} << 20;

}  // namespace

CompiledFunctions::CompiledFunctions(Program program) : program_(std::move(program)) {
    program_.begin(state_, channels_);
}

double CompiledFunctions::operator()(std::size_t index, std::span<const double> arguments) {
    state_.clear_error();
    return program_.call(index, arguments, state_);
}

bool GeneratorExpressions::accept_option(GeneratorWords& words) {
    if (words.accept("-e")) {
        environment_.define(words.text("expression"), {words.program() + " -e", 0});
    } else if (words.accept("-f")) {
        const std::string path =
            context_.library.locate(words.text("function file"), "function file");
        environment_.define(context_.library.files().read(path, kMaxFunctionFileBytes), {path, 1});
    } else {
        return false;
    }
    return true;
}

std::size_t GeneratorExpressions::count(const GeneratorWords& words, const std::string& text,
                                        const std::string& what, std::size_t most) const {
    const ExpressionRequest request{text, -1};
    const Program program =
        environment_.compile(".", {&request, 1}, {}, 0, {words.program() + " " + what, 0});
    EvalState state;
    const ChannelValues channels{};
    program.begin(state, channels);
    const double value = std::floor(program.evaluate(0, state) + 0.5);
    if (!(value >= 1)) words.fail("bad " + what + " \"" + text + "\", expected at least 1");
    if (value > static_cast<double>(most)) {
        words.fail("bad " + what + " \"" + text + "\", expected at most " + std::to_string(most));
    }
    return static_cast<std::size_t>(value);
}

void GeneratorExpressions::define_function(const std::string& program, const std::string& name,
                                           const std::string& parameters, const std::string& body) {
    const std::string head = name + "(" + parameters + ")";
    environment_.define(head + "=" + body + ";", {program + " \"" + body + "\"", 0});
}

int GeneratorExpressions::parameters(const std::string& name) const {
    return environment_.is_function(".", name) ? environment_.parameters(".", name) : 0;
}

Program GeneratorExpressions::compile_program(const std::string& program,
                                              std::span<const std::string> names,
                                              int parameters) const {
    std::vector<ExpressionRequest> requests;
    for (const std::string& name : names) requests.push_back({name, parameters});
    return environment_.compile(".", requests, {}, 0, {program, 0});
}

void GeneratorExpressions::report(const std::string& program,
                                  const CompiledFunctions& functions) const {
    if (functions.numeric_errors() == 0) return;
    context_.warnings.warn(program + ": " + std::to_string(functions.numeric_errors()) +
                           " numeric errors in expressions, 0 taken instead");
}

}  // namespace lightwalk
