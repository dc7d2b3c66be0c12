// Nodes of a graph, folded where that changes neither a bit nor an error.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/function/graph_builder.h"

namespace lightwalk::function {
namespace {

void merge(std::vector<ThunkId>& into, const std::vector<ThunkId>& more) {
    for (const ThunkId id : more) {
        if (std::find(into.begin(), into.end(), id) == into.end()) into.push_back(id);
    }
}

bool is_plain_one(const Node& n) {
    return n.kind == NodeKind::constant && n.value == 1 && !n.clears && n.folded_thunks.empty();
}

}  // namespace

NodeId GraphBuilder::add(Node node) {
    graph_.nodes.push_back(std::move(node));
    return static_cast<NodeId>(graph_.nodes.size() - 1);
}

NodeId GraphBuilder::constant(double value) {
    Node node;
    node.value = value;
    return add(std::move(node));
}

NodeId GraphBuilder::fatal(std::string message) {
    Node node;
    node.kind = NodeKind::fatal;
    node.index = static_cast<std::uint32_t>(graph_.messages.size());
    graph_.messages.push_back(std::move(message));
    return add(std::move(node));
}

std::optional<Node> GraphBuilder::fold(NodeKind kind, std::uint32_t index,
                                       const std::vector<NodeId>& kids) const {
    Node result;
    std::vector<double> x;
    for (const NodeId id : kids) {
        if (!is_constant(id)) return std::nullopt;
        const Node& kid = graph_.nodes[id];
        x.push_back(kid.value);
        result.clears = result.clears || kid.clears;
        merge(result.folded_thunks, kid.folded_thunks);
    }
    if (result.folded_thunks.size() > InlineLimits::kFoldedThunks) return std::nullopt;
    switch (kind) {
        case NodeKind::negation:
            result.value = -x[0];
            return result;
        case NodeKind::difference:
            result.value = x[0] - x[1];
            return result;
        case NodeKind::quotient:
            if (x[1] == 0) return std::nullopt;
            result.value = x[0] / x[1];
            return result;
        case NodeKind::power:
            result.value = std::pow(x[0], x[1]);
            break;
        case NodeKind::library: {
            const auto value = constant_value(static_cast<LibraryFunction>(index), x);
            if (!value) return std::nullopt;
            result.value = *value;
            break;
        }
        default:
            return std::nullopt;
    }
    if (!std::isfinite(result.value)) return std::nullopt;  // the error belongs to run time
    result.clears = true;
    return result;
}

NodeId GraphBuilder::make(NodeKind kind, std::uint32_t index, std::vector<NodeId> kids) {
    if (std::optional<Node> folded = fold(kind, index, kids)) return add(std::move(*folded));
    if (kind == NodeKind::quotient && is_plain_one(graph_.nodes[kids[1]])) return kids[0];
    Node node;
    node.kind = kind;
    node.index = index;
    node.kids = std::move(kids);
    return add(std::move(node));
}

/// A sum or product: the constants that it starts with become one.
NodeId GraphBuilder::list(NodeKind kind, std::vector<NodeId> kids) {
    Node head;
    head.value = kind == NodeKind::sum ? 0.0 : 1.0;
    std::size_t n = 0;
    for (; n < kids.size() && is_constant(kids[n]); ++n) {
        const Node& kid = graph_.nodes[kids[n]];
        std::vector<ThunkId> folded_thunks = head.folded_thunks;
        merge(folded_thunks, kid.folded_thunks);
        if (folded_thunks.size() > InlineLimits::kFoldedThunks) break;
        head.folded_thunks = std::move(folded_thunks);
        head.clears = head.clears || kid.clears;
        head.value = kind == NodeKind::sum ? head.value + kid.value : head.value * kid.value;
    }
    if (n == kids.size()) return add(std::move(head));
    if (n > 1) {
        kids.erase(kids.begin() + 1, kids.begin() + static_cast<std::ptrdiff_t>(n));
        kids[0] = add(std::move(head));
    }
    Node node;
    node.kind = kind;
    node.kids = std::move(kids);
    return add(std::move(node));
}

NodeId GraphBuilder::memoise(NodeId body) {
    const Node& node = graph_.nodes[body];
    switch (node.kind) {
        case NodeKind::channel:
        case NodeKind::input:
        case NodeKind::thunk:
        case NodeKind::parameter:
        case NodeKind::fatal:
            return body;
        case NodeKind::constant:
            if (!node.clears) return body;
            break;
        default:
            break;
    }
    const auto id = static_cast<ThunkId>(graph_.thunks.size());
    graph_.thunks.push_back({body, frame_, frame_ == 0 ? output_ : kNoNode});
    Node reference;
    if (node.kind == NodeKind::constant &&
        node.folded_thunks.size() < InlineLimits::kFoldedThunks) {
        reference.value = node.value;
        reference.folded_thunks = node.folded_thunks;
        reference.folded_thunks.push_back(id);
    } else {
        reference.kind = NodeKind::thunk;
        reference.index = id;
    }
    return add(std::move(reference));
}

/// What is left of a library call of which only one argument is ever chosen.
NodeId GraphBuilder::check(NodeId chosen, const std::vector<ThunkId>& folded_thunks) {
    const Node& node = graph_.nodes[chosen];
    if (node.kind == NodeKind::fatal) return chosen;
    if (node.kind == NodeKind::constant && std::isfinite(node.value)) {
        Node folded = node;
        merge(folded.folded_thunks, folded_thunks);
        folded.clears = true;
        if (folded.folded_thunks.size() <= InlineLimits::kFoldedThunks)
            return add(std::move(folded));
    }
    const bool checked = node.kind == NodeKind::library || node.kind == NodeKind::power ||
                         node.kind == NodeKind::conditional || node.kind == NodeKind::choice ||
                         node.kind == NodeKind::check;
    if (checked && folded_thunks.empty()) return chosen;
    Node result;
    result.kind = NodeKind::check;
    result.folded_thunks = folded_thunks;
    result.kids = {chosen};
    return add(std::move(result));
}

NodeId GraphBuilder::arg_call(NodeId index) {
    if (with_.constant)
        return fatal("bad call to arg(n): it has no value in a constant expression");
    if (!is_constant(index)) {
        return make(NodeKind::library, static_cast<std::uint32_t>(LibraryFunction::arg), {index});
    }
    Node node = graph_.nodes[index];
    const int k = rounded_index(node.value);
    if (k > static_cast<int>(with_.reals.size())) {
        return fatal("bad call to arg(" + std::to_string(k) + "): there are " +
                     std::to_string(with_.reals.size()) + " real arguments");
    }
    const double value = k < 1 ? static_cast<double>(with_.reals.size())
                               : with_.reals[static_cast<std::size_t>(k - 1)];
    if (!std::isfinite(value)) {
        return make(NodeKind::library, static_cast<std::uint32_t>(LibraryFunction::arg), {index});
    }
    node.value = value;
    node.clears = true;
    return add(std::move(node));
}

}  // namespace lightwalk::function
