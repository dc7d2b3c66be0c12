#include "core/function/environment.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/function/code_generator.h"
#include "core/function/graph.h"
#include "core/function/known_values.h"
#include "core/function/listing.h"
#include "core/function/parser.h"
#include "core/function/symbols.h"

namespace lightwalk {

using function::Expr;
using function::ExprKind;
using function::SymbolId;
using function::SymbolTable;

namespace {

/// Work that the constants of one text may take: instructions, and expressions to compile.
constexpr std::uint64_t kConstantOperations = 100000000;
constexpr std::uint64_t kConstantEffort = 2000000;

/// Evaluates constants while a text is parsed.
class ConstantFolder {
  public:
    explicit ConstantFolder(const SymbolTable& symbols) : symbols_(symbols) {}

    double operator()(const Expr& e, const SourceLocation& where) {
        const function::Specialisation specialisation{symbols_, {}, 0, true, where};
        const std::array<function::OutputRequest, 1> request{function::OutputRequest{e, 0}};
        const function::Graph graph = function::build_graph(specialisation, request, effort_);
        const function::Node& root = graph.nodes[graph.outputs[0]];
        if (root.kind == function::NodeKind::constant) {
            check_limits(where);
            return root.value;
        }
        Program::Code code = function::CodeGenerator(graph).generate();
        code.where = where;
        const Program program(std::make_shared<const Program::Code>(std::move(code)));
        const ChannelValues channels{};
        program.begin(state_, channels);
        state_.clear_error();
        const double value = program.evaluate(0, state_);
        operations_ += state_.operations;
        check_limits(where);
        if (state_.error != EvalError::none) {
            const char* kind = state_.error == EvalError::domain ? "domain" : "range";
            throw InputError(
                where, std::string("bad constant expression: ") + kind + " error in " + e.name);
        }
        return value;
    }

  private:
    void check_limits(const SourceLocation& where) const {
        if (operations_ <= kConstantOperations && effort_ <= kConstantEffort) return;
        throw InputError(where, "bad constant expression: the constants take too long to compute");
    }

    const SymbolTable& symbols_;
    EvalState state_;
    std::uint64_t operations_ = 0;
    std::uint64_t effort_ = 0;
};

bool is_name(std::string_view text) {
    return !text.empty() && (function::is_letter(text.front()) || text.front() == '`') &&
           std::all_of(text.begin(), text.end(), function::is_name_character);
}

}  // namespace

struct FunctionEnvironment::Impl {
    explicit Impl(Library library) : symbols(library) {
        parse(function::initial_definitions(library), {"initial definitions", 1}, "", true);
    }

    SymbolTable symbols;
    std::unordered_set<std::string> contexts;
    std::unordered_map<std::string, Program> shared;  ///< by requests and arguments

    void parse(std::string_view text, const SourceLocation& where, std::string_view context,
               bool flat) {
        shared.clear();  // names may refer to other definitions now
        ConstantFolder folder(symbols);
        const function::Scope scope{symbols, &symbols, context, folder};
        function::parse_definitions(text, where, scope, flat);
    }

    /// The request as an expression; a call of a function by name has its values as parameters.
    [[nodiscard]] function::OutputRequest output(const ExpressionRequest& request,
                                                 std::string_view context,
                                                 const SourceLocation& where) const {
        if (request.parameters < 0) {
            ConstantFolder folder(symbols);
            const function::Scope scope{symbols, nullptr, context, folder};
            return {function::parse_expression(request.text, where, scope), 0};
        }
        if (!is_name(request.text)) {
            throw InputError(where, "syntax error: found \"" + request.text +
                                        "\", expected the name of a function");
        }
        Expr call;
        call.kind = ExprKind::call;
        call.name = request.text;
        call.index = symbols.find(request.text, context).value_or(function::kNoSymbol);
        for (int i = 0; i < request.parameters; ++i) {
            Expr value;
            value.kind = ExprKind::parameter;
            value.index = static_cast<std::uint32_t>(i);
            call.kids.push_back(std::move(value));
        }
        return {std::move(call), static_cast<std::uint32_t>(request.parameters)};
    }

    [[nodiscard]] function::Graph graph(std::string_view file,
                                        std::span<const ExpressionRequest> requests,
                                        std::span<const double> reals,
                                        ChannelMask material_channels,
                                        const SourceLocation& where) const {
        const std::string context = function::context_of_file(file);
        std::vector<function::OutputRequest> outputs;
        for (const ExpressionRequest& request : requests)
            outputs.push_back(output(request, context, where));
        std::uint64_t effort = 0;
        return function::build_graph({symbols, reals, material_channels, false, where}, outputs,
                                     effort);
    }

    [[nodiscard]] const function::Symbol* symbol(std::string_view file,
                                                 std::string_view name) const {
        const std::string context = function::context_of_file(file);
        const auto id = is_name(name) ? symbols.find(name, context) : std::nullopt;
        return id ? &symbols[*id] : nullptr;
    }
};

FunctionEnvironment::FunctionEnvironment(Library library) : library_(library) {}
FunctionEnvironment::~FunctionEnvironment() = default;
FunctionEnvironment::FunctionEnvironment(FunctionEnvironment&&) noexcept = default;
FunctionEnvironment& FunctionEnvironment::operator=(FunctionEnvironment&&) noexcept = default;

FunctionEnvironment::Impl& FunctionEnvironment::started() const {
    if (!impl_) impl_ = std::make_unique<Impl>(library_);
    return *impl_;
}

bool FunctionEnvironment::loaded(std::string_view name) const {
    return name == "." || (impl_ && impl_->contexts.contains(function::context_of_file(name)));
}

void FunctionEnvironment::load(const std::string& name, std::string_view text) {
    const std::string context = function::context_of_file(name);
    started().parse(text, {name, 1}, context, true);
    started().contexts.insert(context);
}

void FunctionEnvironment::define(std::string_view text, const SourceLocation& where) {
    started().parse(text, where, "", false);
}

Program FunctionEnvironment::compile(std::string_view file,
                                     std::span<const ExpressionRequest> requests,
                                     std::span<const double> reals, ChannelMask material_channels,
                                     const SourceLocation& where) const {
    const function::Graph graph = started().graph(file, requests, reals, material_channels, where);
    Program::Code code = function::CodeGenerator(graph).generate();
    code.reals.assign(reals.begin(), reals.end());
    code.where = where;
    function::remember_values(code);
    return Program(std::make_shared<const Program::Code>(std::move(code)));
}

Program FunctionEnvironment::shared_program(std::string_view file,
                                            std::span<const ExpressionRequest> requests,
                                            std::span<const double> reals,
                                            ChannelMask material_channels,
                                            const SourceLocation& where) {
    std::string key;
    const auto append = [&key](const void* bytes, std::size_t count) {
        key.append(std::to_string(count)).append(1, ':');
        key.append(static_cast<const char*>(bytes), count);
    };
    append(file.data(), file.size());
    for (const ExpressionRequest& request : requests) {
        append(request.text.data(), request.text.size());
        append(&request.parameters, sizeof(request.parameters));
    }
    append(&material_channels, sizeof(material_channels));
    append(reals.data(), reals.size_bytes());
    auto& shared = started().shared;
    const auto found = shared.find(key);
    if (found != shared.end()) return found->second;
    Program program = compile(file, requests, reals, material_channels, where);
    if (!program.can_throw()) shared.emplace(std::move(key), program);
    return program;
}

FunctionEnvironment::Listing FunctionEnvironment::listing(
    std::string_view file, std::span<const ExpressionRequest> requests,
    std::span<const double> reals, ChannelMask material_channels,
    const SourceLocation& where) const {
    const function::Graph graph = started().graph(file, requests, reals, material_channels, where);
    return {function::listing(graph), function::listing(function::CodeGenerator(graph).generate())};
}

int FunctionEnvironment::parameters(std::string_view file, std::string_view name) const {
    const function::Symbol* symbol = started().symbol(file, name);
    if (!symbol || !symbol->is_function()) return 0;
    return symbol->is_user_function() ? static_cast<int>(symbol->definition->parameters.size())
                                      : symbol->library->arguments;
}

bool FunctionEnvironment::is_function(std::string_view file, std::string_view name) const {
    return parameters(file, name) > 0;
}

}  // namespace lightwalk
