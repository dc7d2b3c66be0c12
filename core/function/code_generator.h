#pragma once
// From a graph to register code.
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/function/code.h"
#include "core/function/graph.h"

namespace lightwalk::function {

/// Lays out expressions in the language's order of evaluation. What is known on the way decides
/// what is emitted: which lazies have been computed for certain, and whether the error flag is
/// clear for certain.
///
/// A lazy that is first needed in one place only is computed right there. One that may be needed
/// first in several becomes a block of its own, which each of them runs unless a mark says that it
/// has been done. Which those are is found by generating the code again until there are no more of
/// them.
class CodeGenerator {
  public:
    explicit CodeGenerator(const Graph& graph);
    [[nodiscard]] Program::Code generate();

  private:
    using Cell = std::uint32_t;
    static constexpr Cell kAnyCell = 0xffffffffu;
    /// Deepest nesting of lazies that are computed in place.
    static constexpr std::uint32_t kDeepest = 400;
    /// A block to generate: of a lazy (node: its body), or of an argument of a call.
    struct Block {
        NodeId node = kNoNode;
        std::uint32_t argument = 0;
        LazyId lazy = kNoNode;
    };

    void measure_graph();
    void reach(NodeId root, std::vector<bool>& seen);
    void start_pass();
    void start_block();
    void generate_frame(std::uint32_t frame);
    void generate_output(std::uint32_t output);
    void generate_blocks(std::vector<Block>& blocks);
    void patch_lazies();

    Cell node(NodeId id, Cell want = kAnyCell);
    Cell leaf(Cell cell, Cell want);
    Cell tick_cell(Cell cell, Cell want);
    Cell constant(const Node& n, Cell want);
    Cell lazy(LazyId id, Cell want);
    Cell parameter(std::uint32_t index, Cell want);
    Cell sum(const Node& n, Cell want);
    Cell product(const Node& n, Cell want);
    Cell difference(const Node& n, Cell want);
    Cell negation(const Node& n, Cell want);
    Cell quotient(const Node& n, Cell want);
    Cell power(const Node& n, Cell want);
    Cell library(const Node& n, Cell want);
    Cell reduction(const Node& n, LibraryFunction f, Cell want);
    Cell conditional(const Node& n, Cell want);
    Cell choice(const Node& n, Cell want);
    Cell check(const Node& n, Cell want);
    Cell call(const Node& n, Cell want);
    std::uint32_t jump_unless(NodeId condition);
    [[nodiscard]] bool is_simple_product(NodeId id) const;
    [[nodiscard]] std::optional<NodeId> remainder_divisor(const Node& n) const;
    [[nodiscard]] bool settled(NodeId id) const;
    bool needed(LazyId id);
    void touch(LazyId id);
    void touch_all(const Node& n);
    void clear_error();
    std::uint8_t begin_checked(std::span<const NodeId> arguments);

    /// Whether evaluating it cannot touch the error flag, nor compute anything for the first time.
    [[nodiscard]] bool quiet(NodeId id, int depth = 0) const;
    /// Quiet, and without an instruction.
    [[nodiscard]] bool at_hand(NodeId id) const;

    std::uint32_t emit(Op op, Cell dst = 0, std::uint32_t a = 0, std::uint32_t b = 0,
                       std::uint32_t c = 0, std::uint8_t keep = 0);
    [[nodiscard]] std::uint32_t here() const {
        return static_cast<std::uint32_t>(code_.instructions.size());
    }
    Cell result(Cell want) { return want == kAnyCell ? temporary() : want; }
    Cell temporary();
    [[nodiscard]] Cell lazy_cell(LazyId id) const;
    [[nodiscard]] bool in_tick() const { return frame_ == 0; }

    // What is known at the present place. Marks are undone at the end of a branch.
    [[nodiscard]] std::size_t available_index_of_parameter(std::uint32_t i) const {
        return graph_.lazies.size() + i;
    }
    void set_available(std::size_t index);
    [[nodiscard]] std::vector<std::size_t> undo_available(std::size_t mark);
    void keep_common(std::vector<std::vector<std::size_t>> branches);

    const Graph& graph_;
    Program::Code code_;
    std::vector<bool> shared_;               ///< lazies that are blocks
    std::vector<std::uint32_t> sites_;       ///< places of this pass that a lazy is first needed at
    std::vector<bool> emitting_;             ///< lazies whose body is being emitted in place
    std::vector<std::uint32_t> entries_;     ///< of the lazies' blocks
    std::vector<std::uint32_t> lazy_index_;  ///< within its frame
    std::vector<std::uint32_t> frame_lazies_;                 ///< how many each frame has
    std::unordered_map<std::uint64_t, Cell> constant_cells_;  ///< by the bits of the value
    std::vector<bool> available_;
    std::vector<std::size_t> available_log_;
    std::vector<Block> tick_blocks_, frame_blocks_;
    std::vector<bool> block_queued_;
    std::vector<std::uint32_t> instances_used_;
    bool changed_ = false;
    bool error_clear_ = false;
    std::uint32_t frame_ = 0;
    std::uint32_t depth_ = 0;
    std::uint32_t parameters_ = 0;  ///< of the function whose frame this is
    Cell next_cell_ = 0;            ///< next free temporary
    Cell high_cell_ = 0;            ///< cells that the frame uses so far
};

}  // namespace lightwalk::function
