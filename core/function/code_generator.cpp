#include "core/function/code_generator.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace lightwalk::function {
namespace {

/// After so many passes every lazy becomes a block: text made to need many passes gets slower code.
constexpr int kPasses = 6;

}  // namespace

CodeGenerator::CodeGenerator(const Graph& graph)
    : graph_(graph),
      shared_(graph.lazies.size(), false),
      lazy_index_(graph.lazies.size(), 0),
      frame_lazies_(graph.instances.size() + 1, 0) {
    for (std::size_t i = 0; i < graph.lazies.size(); ++i) {
        lazy_index_[i] = frame_lazies_[graph.lazies[i].frame]++;
    }
}

/// Mark what evaluating `root` may evaluate.
void CodeGenerator::reach(NodeId root, std::vector<bool>& seen) {
    std::vector<NodeId> todo{root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (id == kNoNode || seen[id]) continue;
        seen[id] = true;
        const Node& n = graph_.nodes[id];
        todo.insert(todo.end(), n.kids.begin(), n.kids.end());
        if (n.kind == NodeKind::lazy) todo.push_back(graph_.lazies[n.index].body);
        if (n.kind == NodeKind::call) todo.push_back(graph_.instances[n.index].body);
    }
}

/// Lazies of the tick that may be needed at times the tick's code does not see are always blocks.
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

    const auto share = [this](LazyId id) {
        const Lazy& lazy = graph_.lazies[id];
        if (lazy.of_tick() && lazy.output == kNoNode) shared_[id] = true;
    };
    for (std::size_t id = 0; id < graph_.nodes.size(); ++id) {
        if (!repeated[id]) continue;
        for (const LazyId touched : graph_.nodes[id].touches) share(touched);
        if (graph_.nodes[id].kind == NodeKind::lazy) share(graph_.nodes[id].index);
    }
}

Program::Code CodeGenerator::generate() {
    measure_graph();
    std::uint32_t inputs = 0;
    for (const std::uint32_t n : graph_.inputs) inputs = std::max(inputs, n);
    code_.inputs_at = static_cast<Cell>(kChannelCount + code_.constants.size());
    code_.lazies_at = code_.inputs_at + inputs;
    code_.lazies = frame_lazies_[0];
    code_.messages = graph_.messages;
    int passes = 0;
    do {
        if (++passes > kPasses) std::fill(shared_.begin(), shared_.end(), true);
        start_pass();
        for (const std::uint32_t i : instances_used_) generate_frame(i + 1);
        generate_frame(0);
    } while (changed_);
    patch_lazies();
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
    sites_.assign(graph_.lazies.size(), 0);
    emitting_.assign(graph_.lazies.size(), false);
    entries_.assign(graph_.lazies.size(), 0);
    block_queued_.assign(graph_.lazies.size(), false);
    tick_blocks_.clear();
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
    if (in_tick()) {
        available_.assign(graph_.lazies.size(), false);
        high_cell_ = code_.lazies_at + code_.lazies;
        for (std::uint32_t k = 0; k < graph_.outputs.size(); ++k) generate_output(k);
        generate_blocks(tick_blocks_);
        code_.cells = high_cell_;
        return;
    }
    const Instance& instance = graph_.instances[frame - 1];
    FunctionCode function;
    function.entry = start;
    function.parameters = static_cast<std::uint32_t>(instance.functions.size());
    function.marked = function.parameters + frame_lazies_[frame];
    available_.assign(graph_.lazies.size() + function.parameters, false);
    parameters_ = function.parameters;
    high_cell_ = function.marked;
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
    for (LazyId id = 0; id < graph_.lazies.size(); ++id) {
        if (graph_.lazies[id].output == output && shared_[id]) emit(Op::invalidate, lazy_cell(id));
    }
    emit(Op::halt, 0, node(root));
    code_.outputs.push_back(code);
}

void CodeGenerator::generate_blocks(std::vector<Block>& blocks) {
    while (!blocks.empty()) {
        const Block block = blocks.back();
        blocks.pop_back();
        start_block();
        if (block.lazy != kNoNode) {
            entries_[block.lazy] = here();
        } else {
            code_.arguments[block.argument].at = here();
        }
        emit(Op::return_block, 0, node(block.node));
    }
}

void CodeGenerator::patch_lazies() {
    for (Instruction& i : code_.instructions) {
        if (i.op == Op::force || i.op == Op::force_global) i.a = entries_[i.a];
    }
}

std::uint32_t CodeGenerator::emit(Op op, Cell dst, std::uint32_t a, std::uint32_t b,
                                  std::uint32_t c, std::uint8_t keep) {
    code_.instructions.push_back({op, keep, dst, a, b, c});
    return here() - 1;
}

CodeGenerator::Cell CodeGenerator::temporary() {
    const Cell cell = next_cell_++;
    high_cell_ = std::max(high_cell_, next_cell_);
    return cell;
}

CodeGenerator::Cell CodeGenerator::lazy_cell(LazyId id) const {
    const Lazy& lazy = graph_.lazies[id];
    if (lazy.of_tick()) return code_.lazies_at + lazy_index_[id];
    return parameters_ + lazy_index_[id];
}

void CodeGenerator::set_available(std::size_t index) {
    available_[index] = true;
    available_log_.push_back(index);
}

std::vector<std::size_t> CodeGenerator::undo_available(std::size_t mark) {
    std::vector<std::size_t> undone(available_log_.begin() + static_cast<std::ptrdiff_t>(mark),
                                    available_log_.end());
    for (const std::size_t index : undone) available_[index] = false;
    available_log_.resize(mark);
    return undone;
}

/// After branches: what each of them has computed.
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

/// Note that a lazy is needed here though it may not have been computed: whether it is a block.
bool CodeGenerator::needed(LazyId id) {
    ++sites_[id];
    if (!shared_[id] && (sites_[id] > 1 || emitting_[id] || depth_ > kDeepest)) {
        shared_[id] = true;
        changed_ = true;
    }
    return shared_[id];
}

void CodeGenerator::touch(LazyId id) {
    if (available_[id]) return;
    if (needed(id)) {
        const bool from_function = graph_.lazies[id].of_tick() && !in_tick();
        emit(from_function ? Op::clear_error_once_global : Op::clear_error_once, lazy_cell(id));
    } else {
        clear_error();
    }
    set_available(id);
}

bool CodeGenerator::quiet(NodeId id, int depth) const {
    constexpr int kDeepestQuiet = 5;
    constexpr std::size_t kMostKids = 8;
    const Node& n = graph_.nodes[id];
    switch (n.kind) {
        case NodeKind::constant:
            return !n.clears && std::all_of(n.touches.begin(), n.touches.end(),
                                            [this](LazyId l) { return available_[l]; });
        case NodeKind::channel:
        case NodeKind::input:
            return true;
        case NodeKind::lazy:
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
    return depth < kDeepestQuiet && n.kids.size() <= kMostKids &&
           std::all_of(n.kids.begin(), n.kids.end(),
                       [&](NodeId kid) { return quiet(kid, depth + 1); });
}

bool CodeGenerator::at_hand(NodeId id) const {
    const NodeKind kind = graph_.nodes[id].kind;
    const bool is_leaf = kind == NodeKind::constant || kind == NodeKind::channel ||
                         kind == NodeKind::input || kind == NodeKind::lazy;
    return in_tick() && is_leaf && quiet(id);
}

}  // namespace lightwalk::function
