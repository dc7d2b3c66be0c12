#pragma once
// Front end of the specialising compiler: from expressions to a graph.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/function/graph.h"

namespace lightwalk::function {

/// Limits of inlining, so that time and memory of compilation are proportional to the size of the
/// text. Beyond them functions are called instead of inlined, with the same results.
struct InlineLimits {
    static constexpr std::uint32_t kDepth = 800;      ///< of recursion while building
    static constexpr std::size_t kNodes = 20000;      ///< of the graph
    static constexpr std::uint64_t kEffort = 200000;  ///< expressions visited
    static constexpr std::size_t kInstances = 2000;   ///< of functions; more is an error
    static constexpr std::size_t kFoldedThunks = 32;  ///< behind one constant
};

/// Names of the material's variables in a mask: "DxA, DyA, DzA".
[[nodiscard]] std::string material_names(ChannelMask channels);

class GraphBuilder {
  public:
    explicit GraphBuilder(const Specialisation& specialisation) : with_(specialisation) {}
    void add_output(const OutputRequest& output);
    /// Build the function instances that calls refer to, and return the graph.
    Graph finish();
    [[nodiscard]] std::uint64_t effort() const { return effort_; }

  private:
    struct Activation;
    struct Binding {
        const Expr* argument = nullptr;  ///< an expression in the caller's scope
        const Activation* caller = nullptr;
        mutable NodeId node = kNoNode;  ///< built when the parameter is first used
    };
    /// A scope of parameters: a call that is being inlined, the body of an instance, or an output.
    struct Activation {
        const Activation* caller =
            nullptr;  ///< the chain of functions that this one is inlined into
        SymbolId symbol = kNoSymbol;
        std::uint32_t conditions = 0;      ///< value of conditions_ on entry
        std::uint32_t argument_depth = 0;  ///< sum of the argument depths along the chain
        std::uint32_t instance = kNoNode;  ///< parameters are this instance's
        std::vector<Binding> bindings;
    };
    enum class Progress : std::uint8_t { building, built };
    struct Variable {
        Progress progress = Progress::building;
        NodeId node = kNoNode;
    };
    /// What a call refers to.
    struct Callee {
        SymbolId symbol = kNoSymbol;
        bool bare_name = true;
    };

    NodeId build(const Expr& e, const Activation* in);
    NodeId build_list(NodeKind kind, const Expr& e, const Activation* in);
    NodeId channel(std::uint32_t index);
    NodeId parameter(const Expr& e, const Activation* in);
    NodeId variable(const Expr& e);
    NodeId build_global(const Expr& body);
    [[nodiscard]] std::optional<Channel> material_channel(const Expr& e) const;
    /// The channels among `channels` that only other materials provide.
    [[nodiscard]] ChannelMask missing_channels(ChannelMask channels) const;

    NodeId call(const Expr& e, const Activation* in);
    [[nodiscard]] Callee callee(const Expr& e, const Activation* in) const;
    NodeId user_call(SymbolId symbol, const Expr& e, const Activation* in);
    NodeId inline_call(SymbolId symbol, const Expr& e, const Activation* in);
    NodeId call_instance(SymbolId symbol, const Expr& e, const Activation* in);
    [[nodiscard]] bool may_inline(SymbolId symbol, std::uint32_t argument_depth,
                                  const Activation* in) const;
    std::uint32_t instance(SymbolId symbol, std::vector<SymbolId> functions);

    NodeId library_call(const LibraryEntry& entry, const Expr& e, const Activation* in);
    NodeId library_argument(const LibraryEntry& entry, const Expr& e, std::size_t i,
                            const Activation* in);
    NodeId if_call(const LibraryEntry& entry, const Expr& e, const Activation* in);
    NodeId select_call(const LibraryEntry& entry, const Expr& e, const Activation* in);
    NodeId arg_call(NodeId index);
    NodeId check(NodeId chosen, const std::vector<ThunkId>& folded_thunks);

    // Make nodes, folding constants where that is exact.
    NodeId add(Node node);
    NodeId constant(double value);
    NodeId fatal(std::string message);
    NodeId make(NodeKind kind, std::uint32_t index, std::vector<NodeId> kids);
    NodeId list(NodeKind kind, std::vector<NodeId> kids);
    std::optional<Node> fold(NodeKind kind, std::uint32_t index,
                             const std::vector<NodeId>& kids) const;
    [[nodiscard]] bool is_constant(NodeId id) const {
        return graph_.nodes[id].kind == NodeKind::constant;
    }
    /// A node for a value that is needed more than once: a thunk, unless `body` costs nothing.
    NodeId memoise(NodeId body);

    const Specialisation& with_;
    Graph graph_;
    std::unordered_map<SymbolId, Variable> variables_;
    std::vector<std::pair<ThunkId, const Expr*>> pending_variables_;
    std::map<std::pair<SymbolId, std::vector<SymbolId>>, std::uint32_t> instances_;
    std::size_t instances_built_ = 0;
    std::uint32_t depth_ = 0;
    std::uint32_t conditions_ = 0;  ///< number of enclosing branches that depend on the ray
    std::uint32_t frame_ = 0;
    std::uint32_t output_ = kNoNode;
    std::uint64_t effort_ = 0;
};

}  // namespace lightwalk::function
