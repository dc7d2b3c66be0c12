// Calls of built-in functions in a graph.
#include <utility>

#include "core/function/graph_builder.h"

namespace lightwalk::function {

NodeId GraphBuilder::library_argument(const LibraryEntry& entry, const Expr& e, std::size_t i,
                                      const Activation* in) {
    if (i < e.kids.size()) return build(e.kids[i], in);
    return fatal(std::string(entry.name) + "(): too few arguments");
}

NodeId GraphBuilder::library_call(const LibraryEntry& entry, const Expr& e, const Activation* in) {
    switch (entry.function) {
        case LibraryFunction::if_:
            return if_call(entry, e, in);
        case LibraryFunction::select:
            return select_call(entry, e, in);
        case LibraryFunction::arg:
            return arg_call(library_argument(entry, e, 0, in));
        default:
            break;
    }
    if (with_.constant && entry.channels != 0)
        return fatal("ray parameter used in constant expression");
    if (const ChannelMask missing = missing_channels(entry.channels)) {
        return fatal(material_names(missing) + ": undefined variable, note_first_use by " +
                     std::string(entry.name) + "()");
    }
    std::vector<NodeId> kids;
    const bool all = entry.kind == LibraryKind::reduction;
    const auto used = all ? e.kids.size() : static_cast<std::size_t>(entry.evaluated);
    for (std::size_t i = 0; i < used; ++i) kids.push_back(library_argument(entry, e, i, in));
    return make(NodeKind::library, static_cast<std::uint32_t>(entry.function), std::move(kids));
}

NodeId GraphBuilder::if_call(const LibraryEntry& entry, const Expr& e, const Activation* in) {
    const NodeId condition = library_argument(entry, e, 0, in);
    if (is_constant(condition)) {
        const bool yes = graph_.nodes[condition].value > 0;
        const NodeId chosen = library_argument(entry, e, yes ? 1 : 2, in);
        return check(chosen, graph_.nodes[condition].folded_thunks);
    }
    ++conditions_;
    const NodeId yes = library_argument(entry, e, 1, in);
    const NodeId no = library_argument(entry, e, 2, in);
    --conditions_;
    return make(NodeKind::conditional, 0, {condition, yes, no});
}

NodeId GraphBuilder::select_call(const LibraryEntry& entry, const Expr& e, const Activation* in) {
    const NodeId selector = library_argument(entry, e, 0, in);
    const auto m = static_cast<int>(e.kids.size()) - 1;
    if (is_constant(selector)) {
        const int k = selected_case(graph_.nodes[selector].value, m);
        if (k >= 0) {
            const NodeId chosen =
                k == 0 ? constant(m) : build(e.kids[static_cast<std::size_t>(k)], in);
            return check(chosen, graph_.nodes[selector].folded_thunks);
        }
    }
    std::vector<NodeId> kids{selector};
    ++conditions_;
    for (std::size_t i = 1; i < e.kids.size(); ++i) kids.push_back(build(e.kids[i], in));
    --conditions_;
    kids.push_back(constant(m));
    return make(NodeKind::choice, 0, std::move(kids));
}

}  // namespace lightwalk::function
