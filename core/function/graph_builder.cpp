#include "core/function/graph_builder.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/function/channel_names.h"

namespace lightwalk::function {
namespace {

/// Sets a variable for its lifetime (scope guard).
template <class T>
class ScopedValue {
  public:
    ScopedValue(T& variable, T value) : variable_(variable), old_(std::exchange(variable, value)) {}
    ~ScopedValue() { variable_ = old_; }
    ScopedValue(const ScopedValue&) = delete;
    ScopedValue& operator=(const ScopedValue&) = delete;

  private:
    T& variable_;
    T old_;
};

constexpr auto kFirstOfMaterial = static_cast<std::size_t>(Channel::NxP);

std::uint32_t deepest(const std::vector<Expr>& expressions) {
    std::uint32_t depth = 0;
    for (const Expr& e : expressions) depth = std::max(depth, e.depth);
    return depth;
}

}  // namespace

std::string material_names(ChannelMask channels) {
    std::string names;
    for (std::size_t c = kFirstOfMaterial; c < kChannelCount; ++c) {
        if ((channels & channel_bit(static_cast<Channel>(c))) == 0) continue;
        if (!names.empty()) names += ", ";
        names += kChannelNames[c];
    }
    return names;
}

Graph build_graph(const Specialisation& specialisation, std::span<const OutputRequest> outputs,
                  std::uint64_t& effort) {
    GraphBuilder builder(specialisation);
    for (const OutputRequest& output : outputs) builder.add_output(output);
    Graph graph = builder.finish();
    effort += builder.effort();
    return graph;
}

void GraphBuilder::add_output(const OutputRequest& output) {
    output_ = static_cast<std::uint32_t>(graph_.outputs.size());
    Activation root;
    for (std::uint32_t i = 0; i < output.inputs; ++i) {
        Binding binding;
        binding.node = make(NodeKind::input, i, {});
        root.bindings.push_back(binding);
    }
    graph_.outputs.push_back(build(output.expression, &root));
    graph_.inputs.push_back(output.inputs);
    output_ = kNoNode;
}

Graph GraphBuilder::finish() {
    while (!pending_variables_.empty() || instances_built_ < graph_.instances.size()) {
        while (!pending_variables_.empty()) {
            const auto [thunk, body] = pending_variables_.back();
            pending_variables_.pop_back();
            const NodeId built = build(*body, nullptr);
            graph_.thunks[thunk].body = built;
        }
        if (instances_built_ == graph_.instances.size()) break;
        const auto i = static_cast<std::uint32_t>(instances_built_++);
        Activation root;
        root.symbol = graph_.instances[i].symbol;
        root.instance = i;
        const ScopedValue<std::uint32_t> frame(frame_, i + 1);
        const NodeId body = build(with_.symbols[root.symbol].definition->body, &root);
        graph_.instances[i].body = body;
    }
    return std::move(graph_);
}

NodeId GraphBuilder::build_list(NodeKind kind, const Expr& e, const Activation* in) {
    std::vector<NodeId> kids;
    kids.reserve(e.kids.size());
    for (const Expr& kid : e.kids) kids.push_back(build(kid, in));
    if (kind == NodeKind::sum || kind == NodeKind::product) return list(kind, std::move(kids));
    return make(kind, 0, std::move(kids));
}

NodeId GraphBuilder::build(const Expr& e, const Activation* in) {
    ++effort_;
    const ScopedValue<std::uint32_t> deeper(depth_, depth_ + 1);
    switch (e.kind) {
        case ExprKind::number:
            return constant(e.value);
        case ExprKind::channel:
            return channel(e.index);
        case ExprKind::parameter:
            return parameter(e, in);
        case ExprKind::variable:
            return variable(e);
        case ExprKind::sum:
            return build_list(NodeKind::sum, e, in);
        case ExprKind::product:
            return build_list(NodeKind::product, e, in);
        case ExprKind::difference:
            return build_list(NodeKind::difference, e, in);
        case ExprKind::quotient:
            return build_list(NodeKind::quotient, e, in);
        case ExprKind::power:
            return build_list(NodeKind::power, e, in);
        case ExprKind::negation:
            return build_list(NodeKind::negation, e, in);
        case ExprKind::call:
        case ExprKind::call_parameter:
            return call(e, in);
    }
    return kNoNode;
}

NodeId GraphBuilder::channel(std::uint32_t index) {
    if (index < 1 || index > static_cast<std::uint32_t>(Channel::Lv)) {
        return fatal("illegal channel $" + std::to_string(index) + ", expected $1 to $27");
    }
    if (with_.constant) return fatal("ray parameter used in constant expression");
    if (with_.symbols.library() == FunctionEnvironment::Library::generator) {
        return fatal("illegal channel $" + std::to_string(index) + ": there is no ray here");
    }
    return make(NodeKind::channel, index, {});
}

NodeId GraphBuilder::parameter(const Expr& e, const Activation* in) {
    assert(in);  // only definitions of functions have parameters
    if (in->instance != kNoNode) return make(NodeKind::parameter, e.index, {});
    if (e.index >= in->bindings.size()) {
        const std::string name = in->symbol == kNoSymbol ? e.name : with_.symbols[in->symbol].name;
        return fatal(name + "(): too few arguments");
    }
    const Binding& binding = in->bindings[e.index];
    if (binding.node == kNoNode) binding.node = memoise(build(*binding.argument, binding.caller));
    return binding.node;
}

ChannelMask GraphBuilder::missing_channels(ChannelMask channels) const {
    const ChannelMask of_material = ~(channel_bit(Channel::NxP) - 1);
    return channels & of_material & ~with_.material_channels;
}

std::optional<Channel> GraphBuilder::material_channel(const Expr& e) const {
    std::string_view name = e.name;
    if (!name.empty() && name.front() == '`') name.remove_prefix(1);
    name = name.substr(0, name.find('`'));
    const auto first = kChannelNames.begin() + kFirstOfMaterial;
    const auto found = std::find(first, kChannelNames.end(), name);
    if (found == kChannelNames.end()) return std::nullopt;
    const auto channel = static_cast<Channel>(found - kChannelNames.begin());
    if (!(with_.material_channels & channel_bit(channel))) return std::nullopt;
    // The normal's variables are global: a definition of the file hides them.
    const bool global = channel <= Channel::RdotP;
    if (global && e.index != kNoSymbol && with_.symbols[e.index].is_variable()) return std::nullopt;
    return channel;
}

NodeId GraphBuilder::build_global(const Expr& body) {
    const ScopedValue<std::uint32_t> frame(frame_, 0);
    const ScopedValue<std::uint32_t> output(output_, kNoNode);
    const ScopedValue<std::uint32_t> conditions(conditions_, 0);
    return memoise(build(body, nullptr));
}

NodeId GraphBuilder::variable(const Expr& e) {
    if (const auto set_by_material = material_channel(e)) {
        return make(NodeKind::channel, static_cast<std::uint32_t>(*set_by_material), {});
    }
    if (e.index == kNoSymbol || !with_.symbols[e.index].is_variable()) {
        return fatal(e.name + ": undefined variable");
    }
    const Expr& body = with_.symbols[e.index].definition->body;
    const auto [found, is_new] = variables_.try_emplace(e.index);
    if (!is_new) {
        if (found->second.progress == Progress::building)
            return constant(0);  // it refers to itself
        return found->second.node;
    }
    NodeId node = kNoNode;
    if (depth_ + body.depth > InlineLimits::kDepth) {
        const auto thunk = static_cast<ThunkId>(graph_.thunks.size());
        graph_.thunks.push_back({});
        pending_variables_.emplace_back(thunk, &body);
        node = make(NodeKind::thunk, thunk, {});
    } else {
        node = build_global(body);
    }
    variables_[e.index] = {Progress::built, node};
    return node;
}

GraphBuilder::Callee GraphBuilder::callee(const Expr& e, const Activation* in) const {
    if (e.kind == ExprKind::call) return {e.index, true};
    const Expr* name = &e;
    const Activation* at = in;
    for (;;) {
        assert(at);
        if (at->instance != kNoNode) {
            const std::vector<SymbolId>& functions = graph_.instances[at->instance].functions;
            const bool given =
                name->index < functions.size() && functions[name->index] != kNoSymbol;
            return {given ? functions[name->index] : kNoSymbol, given};
        }
        if (name->index >= at->bindings.size()) return {kNoSymbol, false};
        const Binding& binding = at->bindings[name->index];
        if (!binding.argument) return {kNoSymbol, false};
        if (binding.argument->kind == ExprKind::variable) return {binding.argument->index, true};
        if (binding.argument->kind != ExprKind::parameter) return {kNoSymbol, false};
        name = binding.argument;
        at = binding.caller;
    }
}

NodeId GraphBuilder::call(const Expr& e, const Activation* in) {
    const Callee called = callee(e, in);
    if (!called.bare_name) return fatal(e.name + "(): argument not a function");
    if (called.symbol == kNoSymbol) return fatal(e.name + "(): undefined function");
    const Symbol& symbol = with_.symbols[called.symbol];
    if (symbol.is_user_function()) return user_call(called.symbol, e, in);
    if (symbol.library) return library_call(*symbol.library, e, in);
    return fatal(e.name + "(): undefined function");
}

/// Recursion is unrolled while no branch that depends on the ray lies between one level and the
/// next: each of them would be called, so that what ends the recursion must be known here.
bool GraphBuilder::may_inline(SymbolId symbol, std::uint32_t argument_depth,
                              const Activation* in) const {
    const std::uint32_t chain = argument_depth + (in ? in->argument_depth : 0);
    const std::uint32_t body = with_.symbols[symbol].definition->body.depth;
    if (depth_ + chain + body > InlineLimits::kDepth) return false;
    if (graph_.nodes.size() > InlineLimits::kNodes || effort_ > InlineLimits::kEffort) return false;
    for (const Activation* a = in; a; a = a->caller) {
        if (a->symbol == symbol) return a->conditions == conditions_;
    }
    return true;
}

NodeId GraphBuilder::user_call(SymbolId symbol, const Expr& e, const Activation* in) {
    return may_inline(symbol, deepest(e.kids), in) ? inline_call(symbol, e, in)
                                                   : call_instance(symbol, e, in);
}

NodeId GraphBuilder::inline_call(SymbolId symbol, const Expr& e, const Activation* in) {
    const Definition& definition = *with_.symbols[symbol].definition;
    Activation activation;
    activation.caller = in;
    activation.symbol = symbol;
    activation.conditions = conditions_;
    activation.argument_depth = deepest(e.kids) + (in ? in->argument_depth : 0);
    const std::size_t n = std::min(e.kids.size(), definition.parameters.size());
    activation.bindings.reserve(n);
    for (std::size_t i = 0; i < n; ++i) activation.bindings.push_back({&e.kids[i], in, kNoNode});
    return build(definition.body, &activation);
}

NodeId GraphBuilder::call_instance(SymbolId symbol, const Expr& e, const Activation* in) {
    const Definition& definition = *with_.symbols[symbol].definition;
    std::vector<NodeId> kids;
    std::vector<SymbolId> functions;
    for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
        functions.push_back(kNoSymbol);
        if (i >= e.kids.size()) {
            kids.push_back(fatal(with_.symbols[symbol].name + "(): too few arguments"));
            continue;
        }
        const Expr& argument = e.kids[i];
        if (argument.kind == ExprKind::variable && argument.index != kNoSymbol &&
            with_.symbols[argument.index].is_function()) {
            functions.back() = argument.index;
        } else if (argument.kind == ExprKind::parameter) {
            const Callee passed = callee(argument, in);
            if (passed.symbol != kNoSymbol && with_.symbols[passed.symbol].is_function()) {
                functions.back() = passed.symbol;
            }
        }
        kids.push_back(build(argument, in));
    }
    const std::uint32_t id = instance(symbol, std::move(functions));
    return make(NodeKind::call, id, std::move(kids));
}

std::uint32_t GraphBuilder::instance(SymbolId symbol, std::vector<SymbolId> functions) {
    const auto id = static_cast<std::uint32_t>(graph_.instances.size());
    const auto [found, is_new] = instances_.try_emplace({symbol, functions}, id);
    if (is_new) {
        if (instances_.size() > InlineLimits::kInstances) {
            throw InputError(with_.where, "expression too complicated: it needs more than " +
                                              std::to_string(InlineLimits::kInstances) +
                                              " functions");
        }
        graph_.instances.push_back({symbol, std::move(functions), kNoNode});
    }
    return found->second;
}

}  // namespace lightwalk::function
