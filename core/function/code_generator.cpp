#include "core/function/code_generator.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace lightwalk::function {
namespace {

/// After so many passes all remaining thunks go out of line, which bounds compilation for texts
/// made to need many passes.
constexpr int kPasses = 6;

}  // namespace

CodeGenerator::CodeGenerator(const Graph& graph)
    : graph_(graph),
      out_of_line_(graph.thunks.size(), false),
      thunk_index_(graph.thunks.size(), 0),
      frame_thunks_(graph.instances.size() + 1, 0) {
    for (std::size_t i = 0; i < graph.thunks.size(); ++i) {
        thunk_index_[i] = frame_thunks_[graph.thunks[i].frame]++;
    }
}

/// Note in `seen` what evaluating `root` may evaluate.
void CodeGenerator::reach(NodeId root, std::vector<bool>& seen) {
    std::vector<NodeId> todo{root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (id == kNoNode || seen[id]) continue;
        seen[id] = true;
        const Node& n = graph_.nodes[id];
        todo.insert(todo.end(), n.kids.begin(), n.kids.end());
        if (n.kind == NodeKind::thunk) todo.push_back(graph_.thunks[n.index].body);
        if (n.kind == NodeKind::call) todo.push_back(graph_.instances[n.index].body);
    }
}

/// What the program reads, and which thunks have to be out of line whatever the passes say: those
/// of the global frame that calls need, since the code of that frame does not see when.
void CodeGenerator::measure_graph() {
    std::vector<bool> repeated(graph_.nodes.size(), false);
    std::vector<bool> used(graph_.nodes.size(), false);
    for (std::size_t k = 0; k < graph_.outputs.size(); ++k) {
        reach(graph_.outputs[k], used);
        if (graph_.inputs[k] > 0) reach(graph_.outputs[k], repeated);
    }
    std::vector<bool> called(graph_.instances.size(), false);
    for (std::size_t id = 0; id < graph_.nodes.size(); ++id) {
        const Node& n = graph_.nodes[id];
        if (!used[id]) continue;
        if (n.kind == NodeKind::call && !called[n.index]) {
            called[n.index] = true;
            instances_used_.push_back(n.index);
            reach(graph_.instances[n.index].body, repeated);
        }
        if (n.kind == NodeKind::channel) {
            code_.channels |= ChannelMask{1} << n.index;
            code_.used_channels.push_back(static_cast<std::uint8_t>(n.index));
        }
        if (n.kind == NodeKind::library) {
            code_.channels |= library_entry(static_cast<LibraryFunction>(n.index)).channels;
        }
        if (n.kind == NodeKind::constant) {
            const auto bits = std::bit_cast<std::uint64_t>(n.value);
            const auto cell = static_cast<Cell>(kChannelCount + code_.constants.size());
            if (constant_cells_.try_emplace(bits, cell).second) code_.constants.push_back(n.value);
        }
    }
    std::sort(code_.used_channels.begin(), code_.used_channels.end());
    const auto last = std::unique(code_.used_channels.begin(), code_.used_channels.end());
    code_.used_channels.erase(last, code_.used_channels.end());

    const auto share = [this](ThunkId id) {
        const Thunk& thunk = graph_.thunks[id];
        if (thunk.is_global() && thunk.output == kNoNode) out_of_line_[id] = true;
    };
    for (std::size_t id = 0; id < graph_.nodes.size(); ++id) {
        if (!repeated[id]) continue;
        for (const ThunkId folded : graph_.nodes[id].folded_thunks) share(folded);
        if (graph_.nodes[id].kind == NodeKind::thunk) share(graph_.nodes[id].index);
    }
}

Program::Code CodeGenerator::generate() {
    measure_graph();
    std::uint32_t inputs = 0;
    for (const std::uint32_t n : graph_.inputs) inputs = std::max(inputs, n);
    code_.inputs_at = static_cast<Cell>(kChannelCount + code_.constants.size());
    code_.thunks_at = code_.inputs_at + inputs;
    code_.thunks = frame_thunks_[0];
    code_.messages = graph_.messages;
    int passes = 0;
    do {
        if (++passes > kPasses) std::fill(out_of_line_.begin(), out_of_line_.end(), true);
        start_pass();
        for (const std::uint32_t i : instances_used_) generate_frame(i + 1);
        generate_frame(0);
    } while (changed_);
    set_thunk_entries();
    code_.has_lanes =
        inputs == 0 && std::all_of(code_.instructions.begin(), code_.instructions.end(),
                                   [](const Instruction& i) { return op_entry(i.op).lanes; });
    return std::move(code_);
}

void CodeGenerator::start_pass() {
    changed_ = false;
    code_.instructions.clear();
    code_.arguments.clear();
    code_.targets.clear();
    code_.outputs.clear();
    code_.functions.assign(graph_.instances.size(), {});
    first_uses_.assign(graph_.thunks.size(), 0);
    emitting_.assign(graph_.thunks.size(), false);
    entries_.assign(graph_.thunks.size(), 0);
    block_queued_.assign(graph_.thunks.size(), false);
    global_blocks_.clear();
}

void CodeGenerator::start_block() {
    for (const std::size_t index : available_log_) available_[index] = false;
    available_log_.clear();
    error_clear_ = false;
    next_cell_ = high_cell_;
}

void CodeGenerator::generate_frame(std::uint32_t frame) {
    frame_ = frame;
    const std::uint32_t start = here();
    available_log_.clear();
    if (in_global_frame()) {
        available_.assign(graph_.thunks.size(), false);
        high_cell_ = code_.thunks_at + code_.thunks;
        for (std::uint32_t k = 0; k < graph_.outputs.size(); ++k) generate_output(k);
        generate_blocks(global_blocks_);
        code_.cells = high_cell_;
        return;
    }
    const Instance& instance = graph_.instances[frame - 1];
    FunctionCode function;
    function.entry = start;
    function.parameters = static_cast<std::uint32_t>(instance.functions.size());
    function.cached = function.parameters + frame_thunks_[frame];
    available_.assign(graph_.thunks.size() + function.parameters, false);
    parameters_ = function.parameters;
    high_cell_ = function.cached;
    start_block();
    emit(Op::return_call, 0, node(instance.body));
    generate_blocks(frame_blocks_);
    function.cells = high_cell_;
    function.cost = here() - start;
    code_.functions[frame - 1] = function;
}

void CodeGenerator::generate_output(std::uint32_t output) {
    start_block();
    const NodeId root = graph_.outputs[output];
    OutputCode code;
    code.entry = here();
    code.inputs = graph_.inputs[output];
    code.is_constant = graph_.nodes[root].kind == NodeKind::constant;
    code.value = graph_.nodes[root].value;
    for (ThunkId id = 0; id < graph_.thunks.size(); ++id) {
        if (graph_.thunks[id].output == output && out_of_line_[id])
            emit(Op::invalidate, thunk_cell(id));
    }
    emit(Op::halt, 0, node(root));
    code_.outputs.push_back(code);
}

void CodeGenerator::generate_blocks(std::vector<Block>& blocks) {
    while (!blocks.empty()) {
        const Block block = blocks.back();
        blocks.pop_back();
        start_block();
        if (block.thunk != kNoNode) {
            entries_[block.thunk] = here();
        } else {
            code_.arguments[block.argument].at = here();
        }
        emit(Op::return_block, 0, node(block.node));
    }
}

void CodeGenerator::set_thunk_entries() {
    for (Instruction& i : code_.instructions) {
        if (i.op == Op::force || i.op == Op::force_global) i.a = entries_[i.a];
    }
}

std::uint32_t CodeGenerator::emit(Op op, Cell dst, std::uint32_t a, std::uint32_t b,
                                  std::uint32_t c, std::uint8_t error_mask) {
    code_.instructions.push_back({op, error_mask, dst, a, b, c});
    return here() - 1;
}

CodeGenerator::Cell CodeGenerator::temporary() {
    const Cell cell = next_cell_++;
    high_cell_ = std::max(high_cell_, next_cell_);
    return cell;
}

CodeGenerator::Cell CodeGenerator::thunk_cell(ThunkId id) const {
    const Thunk& thunk = graph_.thunks[id];
    if (thunk.is_global()) return code_.thunks_at + thunk_index_[id];
    return parameters_ + thunk_index_[id];
}

void CodeGenerator::set_available(std::size_t index) {
    available_[index] = true;
    available_log_.push_back(index);
}

std::vector<std::size_t> CodeGenerator::undo_available(std::size_t start) {
    std::vector<std::size_t> undone(available_log_.begin() + static_cast<std::ptrdiff_t>(start),
                                    available_log_.end());
    for (const std::size_t index : undone) available_[index] = false;
    available_log_.resize(start);
    return undone;
}

/// After branches, keeps as available what every branch has computed.
void CodeGenerator::keep_common(std::vector<std::vector<std::size_t>> branches) {
    for (auto& branch : branches) std::sort(branch.begin(), branch.end());
    std::vector<std::size_t> common = branches.front();
    for (const auto& branch : branches) {
        std::vector<std::size_t> both;
        std::set_intersection(common.begin(), common.end(), branch.begin(), branch.end(),
                              std::back_inserter(both));
        common = std::move(both);
    }
    for (const std::size_t index : common) set_available(index);
}

void CodeGenerator::clear_error() {
    if (!error_clear_) emit(Op::clear_error);
    error_clear_ = true;
}

/// Counts a place where a thunk is needed that may not be valid yet. Returns whether its code is
/// out of line.
bool CodeGenerator::note_first_use(ThunkId id) {
    ++first_uses_[id];
    if (!out_of_line_[id] && (first_uses_[id] > 1 || emitting_[id] || depth_ > kDeepest)) {
        out_of_line_[id] = true;
        changed_ = true;
    }
    return out_of_line_[id];
}

void CodeGenerator::use_folded_thunk(ThunkId id) {
    if (available_[id]) return;
    if (note_first_use(id)) {
        const bool from_function = graph_.thunks[id].is_global() && !in_global_frame();
        emit(from_function ? Op::clear_error_once_global : Op::clear_error_once, thunk_cell(id));
    } else {
        clear_error();
    }
    set_available(id);
}

bool CodeGenerator::is_side_effect_free(NodeId id, int depth) const {
    constexpr int kDeepestSearch = 5;
    constexpr std::size_t kMostKids = 8;
    const Node& n = graph_.nodes[id];
    switch (n.kind) {
        case NodeKind::constant:
            return !n.clears && std::all_of(n.folded_thunks.begin(), n.folded_thunks.end(),
                                            [this](ThunkId l) { return available_[l]; });
        case NodeKind::channel:
        case NodeKind::input:
            return true;
        case NodeKind::thunk:
            return available_[n.index];
        case NodeKind::parameter:
            return available_[available_index_of_parameter(n.index)];
        case NodeKind::quotient:
            if (graph_.nodes[n.kids[1]].kind != NodeKind::constant) return false;
            if (graph_.nodes[n.kids[1]].value == 0) return false;
            break;
        case NodeKind::sum:
        case NodeKind::product:
        case NodeKind::difference:
        case NodeKind::negation:
            break;
        default:
            return false;
    }
    return depth < kDeepestSearch && n.kids.size() <= kMostKids &&
           std::all_of(n.kids.begin(), n.kids.end(),
                       [&](NodeId kid) { return is_side_effect_free(kid, depth + 1); });
}

bool CodeGenerator::is_in_cell(NodeId id) const {
    const NodeKind kind = graph_.nodes[id].kind;
    const bool is_leaf = kind == NodeKind::constant || kind == NodeKind::channel ||
                         kind == NodeKind::input || kind == NodeKind::thunk;
    return in_global_frame() && is_leaf && is_side_effect_free(id);
}

}  // namespace lightwalk::function
