#include "parallel/ranks/rank_roles.h"

#include <memory>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr int kChunksAThread = 4;  ///< one is traced, others wait there, here, or to be written

template <class Role>
Role& expected(std::optional<Role>& role) {
    if (!role) throw InputError("a rank has got a message that is not for it");
    return *role;
}

}  // namespace

RankRoles::RankRoles(int rank, const Topology& topology, const RankSettings& settings)
    : rank_(rank),
      rays_(settings.rays),
      collectives_(topology, owners_of(topology.workers.size(), settings.projectors)) {
    const auto workers = std::make_shared<const std::vector<int>>(topology.worker_ranks());
    if (rank == 0) {
        const int threads = settings.slots * static_cast<int>(workers->size());
        queue_.emplace(
            WorkQueue::Options{topology.children,
                               workers->size(),
                               collectives_.members(Collective::Group::owners),
                               {settings.block, settings.stride, threads, settings.makes_values},
                               static_cast<std::uint32_t>(kChunksAThread * threads)});
    }
    for (const Topology::SubQueue& sub : topology.sub_queues) {
        if (sub.rank != rank) continue;
        sub_queue_.emplace(rank, sub.children,
                           sub.children.size() * static_cast<std::size_t>(settings.slots));
    }
    if (const auto index = topology.worker_index(rank)) {
        worker_.emplace(Worker::Options{rank, topology.workers[*index].queue, *index, workers,
                                        settings.slots, settings.ahead, settings.encode});
    }
    if (!topology.ambient_master || settings.ambient_batch == 0) return;
    if (*topology.ambient_master == rank) ambient_master_.emplace(rank);
    ambient_client_.emplace(rank, *topology.ambient_master, settings.ambient_batch);
}

void RankRoles::begin(Outbox& out) {
    if (sub_queue_) sub_queue_->begin(out);
    if (worker_) worker_->begin(out);
    if (queue_ && rays_) queue_->open_stream(out);
}

void RankRoles::handle(int from, Message message, Outbox& out) {
    // What a queue hands down comes from the own rank where that is one of the queue's workers.
    const bool for_sub_queue = sub_queue_ && from != rank_;
    std::visit(
        Overloaded{[&](Announcement& m) {
                       if (for_sub_queue) return sub_queue_->handle(m, out);
                       expected(worker_).handle(std::move(m), out);
                   },
                   [&](WorkGrant& m) {
                       if (for_sub_queue) return sub_queue_->handle(std::move(m), out);
                       expected(worker_).handle(std::move(m), out);
                   },
                   [&](WorkRequest& m) {
                       if (sub_queue_) return sub_queue_->handle(from, m, out);
                       expected(queue_).handle(from, m, out);
                   },
                   [&](WorkResult& m) { handle_result(std::move(m), out); },
                   [&](FinishedPart& m) { expected(queue_).handle(from, std::move(m), out); },
                   [&](UncachedPixels& m) { expected(queue_).handle(from, std::move(m), out); },
                   [&](PointExchange& m) { out.tracers.emplace_back(std::move(m)); },
                   [&](AmbientValues& m) {
                       if (m.direction == AmbientValues::Direction::news)
                           expected(ambient_client_).handle(std::move(m), out);
                       else
                           expected(ambient_master_).handle(from, m, out);
                   },
                   [&](Collective& m) { collectives_.handle(from, std::move(m), out); },
                   [&](Notice& m) {
                       if (for_sub_queue && std::holds_alternative<Finish>(m.notice))
                           sub_queue_->finish(out);
                       out.program.emplace_back(RankNotice{from, std::move(m)});
                   }},
        message);
}

Activity activity_of(const Message& message) {
    return std::visit(Overloaded{[](const WorkResult&) { return Activity::send; },
                                 [](const PointExchange&) { return Activity::send; },
                                 [](const AmbientValues&) { return Activity::exchange; },
                                 [](const Announcement&) { return Activity::handle; },
                                 [](const WorkRequest&) { return Activity::handle; },
                                 [](const WorkGrant&) { return Activity::handle; },
                                 [](const FinishedPart&) { return Activity::handle; },
                                 [](const UncachedPixels&) { return Activity::handle; },
                                 [](const Collective&) { return Activity::handle; },
                                 [](const Notice&) { return Activity::handle; }},
                      message);
}

void RankRoles::handle_result(WorkResult result, Outbox& out) {
    std::visit(Overloaded{[&](Pixels& m) { expected(worker_).store(std::move(m), out); },
                          [&](LoggedPixels& m) { out.program.emplace_back(std::move(m)); },
                          [&](RayAnswer& m) { expected(queue_).handle(std::move(m), out); },
                          [&](TracedRun& m) { out.tracers.emplace_back(std::move(m)); }},
               result.result);
}

}  // namespace lightwalk
