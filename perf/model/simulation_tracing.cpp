// The threads that trace, in the simulation.
#include <algorithm>

#include "perf/model/simulation.h"
#include "perf/model/simulation_state.h"

namespace lightwalk {

/// Threads of a rank that are free begin the blocks that it has.
void Simulation::trace(std::size_t number) {
    Rank& rank = ranks_[number];
    while (rank.free_threads > 0 && rank.next_block < rank.blocks.size()) {
        const JobBlock work = rank.blocks[rank.next_block];
        // The picture's threads of one process wait until all have ended the prepass.
        if (run_.variant == Variant::threads && !is_prepass(work.job) &&
            rank.next_block > threads_done_ && is_prepass(rank.blocks[threads_done_].job))
            return;
        ++rank.next_block;
        if (rank.next_block == rank.blocks.size() && run_.variant != Variant::threads) {
            rank.blocks.clear();
            rank.next_block = 0;
        }
        --rank.free_threads;
        begin(number, work);
    }
}

void Simulation::begin(std::size_t number, const JobBlock& work) {
    Rank& rank = ranks_[number];
    int task = static_cast<int>(tasks_.size());
    if (free_tasks_.empty()) {
        tasks_.emplace_back();
    } else {
        task = free_tasks_.back();
        free_tasks_.pop_back();
    }
    Task& t = tasks_[static_cast<std::size_t>(task)];
    t.rank = number;
    t.work = work;
    t.next_row = work.block.y0;
    t.began = now_;
    t.setup = map_.block_seconds;
    if (work.job >= rank.set_up) {
        t.setup += map_.setup_seconds;
        rank.set_up = work.job + 1;
    }
    ++prediction_.blocks;
    next_step(task);
}

/// Without ambient values a block is one step; with them a row of cells, between which the cache
/// may have got values from elsewhere.
void Simulation::next_step(int task) {
    Task& t = tasks_[static_cast<std::size_t>(task)];
    PixelRectangle part = t.work.block;
    part.y0 = t.next_row;
    constexpr int kRows = 8;
    if (sites_) part.y1 = std::min(part.y1, part.y0 - part.y0 % kRows + kRows);
    t.next_row = part.y1;
    double work = t.setup;
    t.setup = 0;
    work += is_prepass(t.work.job) ? prepass_costs_.seconds(part) : picture_costs_.seconds(part);
    if (sites_) work += make_values(t, part);
    const std::size_t node = node_of(t.rank);
    nodes_[node].add(now_, task, work * machine_.slowness);
    look_ahead(node);
}

/// Seconds to make the values that are missing for a part of the picture.
double Simulation::make_values(Task& task, const PixelRectangle& part) {
    const bool coarse = is_prepass(task.work.job);
    const double width = coarse ? map_.prepass.width : run_.width;
    const double height = coarse ? map_.prepass.height : run_.height;
    sites_->needed(part.x0 / width, part.y0 / height, part.x1 / width, part.y1 / height, coarse,
                   needed_);
    Rank& rank = ranks_[task.rank];
    double seconds = 0;
    for (const std::uint32_t site : needed_) {
        if (rank.known[site]) continue;
        rank.known[site] = true;
        task.making.push_back(site);
        seconds += sites_->making(site);
    }
    prediction_.values_made += task.making.size();
    return seconds;
}

void Simulation::end_step(int task) {
    Task& t = tasks_[static_cast<std::size_t>(task)];
    const std::size_t node = node_of(t.rank);
    nodes_[node].remove(now_, task);
    for (const std::uint32_t value : t.making) keep(t.rank, value);
    t.making.clear();
    if (t.next_row < t.work.block.y1)
        next_step(task);
    else
        finish(task);
    look_ahead(node);
}

/// Batches as SharedCache makes them.
void Simulation::keep(std::size_t number, std::uint32_t value) {
    Rank& rank = ranks_[number];
    if (!rank.roles || !rank.roles->ambient_client()) return;
    AmbientRecord record;
    record.normal = value;
    rank.own.push_back(record);
    if (rank.own.size() < static_cast<std::size_t>(run_.ambient_batch)) return;
    post(number, {[own = std::exchange(rank.own, {})](RankRoles& roles, Outbox& out) {
             roles.ambient_client()->offer({own}, out);
         }});
}

void Simulation::finish(int task) {
    const Task& t = tasks_[static_cast<std::size_t>(task)];
    const std::size_t number = t.rank;
    ++ranks_[number].free_threads;
    free_tasks_.push_back(task);
    if (run_.variant == Variant::threads) {
        if (++threads_done_ == threads_blocks_) end_ = now_;
    } else {
        const auto pixels = static_cast<std::uint32_t>(t.work.block.pixels());
        const FinishedWork finished{FinishedWork::Payload::block, t.work.job, pixels,
                                    now_ - t.began};
        // The block's pixels are copied to where they belong.
        post(number, {[finished, work = t.work](RankRoles& roles, Outbox& out) {
                          roles.worker().finish(finished, Pixels{work, {}}, out);
                      },
                      machine_.byte_work * kPixelBytes * pixels});
    }
    trace(number);
}

/// Something has changed on a node: when does its next task end now?
void Simulation::look_ahead(std::size_t node) {
    const auto next = nodes_[node].next(now_);
    ++versions_[node];
    if (next) at(std::max(now_, next->first), Kind::traced, node, versions_[node]);
}

double seconds_on_one(const CostMap& map, const Machine& machine, const SimulatedRun& run) {
    SimulatedRun alone = run;
    alone.variant = Variant::threads;
    alone.ranks = alone.threads = 1;
    return Simulation(map, machine, alone).run().seconds;
}

}  // namespace lightwalk
