#pragma once
// Code generation: from a graph to register code.
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/function/code.h"
#include "core/function/graph.h"

namespace lightwalk::function {

/// Emits expressions in the language's order of evaluation. The code depends on what is certain at
/// a place: which thunks are valid ("available expressions" of a compiler), and whether the error
/// flag is clear.
///
/// A thunk whose value can first be needed in one place only is evaluated in line. A thunk with
/// several such places becomes a block of its own, which `force` runs unless the cell is valid. To
/// find these thunks, code is generated repeatedly until there are no new ones.
///
/// A parameter `Cell into` is where the caller wants the value; kAnyCell lets the generator choose,
/// which saves a copy of a value that is in a cell already.
class CodeGenerator {
  public:
    explicit CodeGenerator(const Graph& graph);
    [[nodiscard]] Program::Code generate();

  private:
    using Cell = std::uint32_t;
    static constexpr Cell kAnyCell = 0xffffffffu;
    /// Deepest nesting of thunks that are evaluated in line.
    static constexpr std::uint32_t kDeepest = 400;
    /// A block to generate: for a thunk (`node` is its body), or for an argument of a call.
    struct Block {
        NodeId node = kNoNode;
        std::uint32_t argument = 0;
        ThunkId thunk = kNoNode;
    };

    void measure_graph();
    void reach(NodeId root, std::vector<bool>& seen);
    void start_pass();
    void start_block();
    void generate_frame(std::uint32_t frame);
    void generate_output(std::uint32_t output);
    void generate_blocks(std::vector<Block>& blocks);
    void set_thunk_entries();

    Cell node(NodeId id, Cell into = kAnyCell);
    Cell node_of_kind(const Node& n, Cell into);
    Cell leaf(Cell cell, Cell into);
    Cell global_cell(Cell cell, Cell into);
    Cell constant(const Node& n, Cell into);
    Cell thunk(ThunkId id, Cell into);
    Cell parameter(std::uint32_t index, Cell into);
    Cell sum(const Node& n, Cell into);
    Cell product(const Node& n, Cell into);
    Cell difference(const Node& n, Cell into);
    Cell negation(const Node& n, Cell into);
    Cell quotient(const Node& n, Cell into);
    Cell power(const Node& n, Cell into);
    Cell library(const Node& n, Cell into);
    Cell reduction(const Node& n, LibraryFunction f, Cell into);
    Cell conditional(const Node& n, Cell into);
    Cell choice(const Node& n, Cell into);
    Cell check(const Node& n, Cell into);
    Cell call(const Node& n, Cell into);
    std::uint32_t jump_unless(NodeId condition);
    [[nodiscard]] bool is_simple_product(NodeId id) const;
    [[nodiscard]] std::optional<NodeId> remainder_divisor(const Node& n) const;
    [[nodiscard]] bool is_already_checked(NodeId id) const;
    bool note_first_use(ThunkId id);
    void use_folded_thunk(ThunkId id);
    void use_folded_thunks(const Node& n);
    void clear_error();
    std::uint8_t begin_checked(std::span<const NodeId> arguments);

    /// Whether evaluating a node changes neither the error flag nor the validity of thunks, so that
    /// it may be moved. Conservative: false where analysis would take long.
    [[nodiscard]] bool is_side_effect_free(NodeId id, int depth = 0) const;
    /// Whether the value of a node is in a cell already, so that it needs no instruction.
    [[nodiscard]] bool is_in_cell(NodeId id) const;

    std::uint32_t emit(Op op, Cell dst = 0, std::uint32_t a = 0, std::uint32_t b = 0,
                       std::uint32_t c = 0, std::uint8_t error_mask = 0);
    [[nodiscard]] std::uint32_t here() const {
        return static_cast<std::uint32_t>(code_.instructions.size());
    }
    Cell result(Cell into) { return into == kAnyCell ? temporary() : into; }
    Cell temporary();
    [[nodiscard]] Cell thunk_cell(ThunkId id) const;
    [[nodiscard]] bool in_global_frame() const { return frame_ == 0; }

    // Bookkeeping of the thunks and parameters that are certainly valid at the present place. What
    // a branch adds is undone at its end: `start` is the length of available_log_ before the
    // branch.
    [[nodiscard]] std::size_t available_index_of_parameter(std::uint32_t i) const {
        return graph_.thunks.size() + i;
    }
    void set_available(std::size_t index);
    [[nodiscard]] std::vector<std::size_t> undo_available(std::size_t start);
    void keep_common(std::vector<std::vector<std::size_t>> branches);

    const Graph& graph_;
    Program::Code code_;
    std::vector<bool> out_of_line_;  ///< thunks that have blocks of their own
    std::vector<std::uint32_t>
        first_uses_;  ///< number of places, in this pass, where a thunk may be first needed
    std::vector<bool> emitting_;               ///< thunks whose body is being emitted in line
    std::vector<std::uint32_t> entries_;       ///< first instructions of the thunks' blocks
    std::vector<std::uint32_t> thunk_index_;   ///< index of each thunk within its frame
    std::vector<std::uint32_t> frame_thunks_;  ///< number of thunks of each frame
    std::unordered_map<std::uint64_t, Cell>
        constant_cells_;  ///< cells of constants, by the bits of the value
    std::vector<bool> available_;
    std::vector<std::size_t> available_log_;
    std::vector<Block> global_blocks_, frame_blocks_;
    std::vector<bool> block_queued_;
    std::vector<std::uint32_t> instances_used_;
    bool changed_ = false;
    bool error_clear_ = false;
    std::uint32_t frame_ = 0;
    std::uint32_t depth_ = 0;
    std::uint32_t parameters_ = 0;  ///< number of parameters of the present function
    Cell next_cell_ = 0;            ///< next free temporary
    Cell high_cell_ = 0;            ///< cells that the frame uses so far
};

}  // namespace lightwalk::function
