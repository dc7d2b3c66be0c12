#pragma once
// All ranks' roles in one thread, on a random schedule. Tracing takes random times.
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "parallel/ranks/roles.h"
#include "tests/parallel/ranks/random_schedule.h"

namespace lightwalk::test {

struct NetworkOptions {
    Variant variant = Variant::ranks;
    int ranks = 4;
    int masters = 1;
    int slots = 1, ahead = 1;
    int block = 0, stride = 0;
    std::size_t batch = 0;  ///< ambient values a message; 0: none are exchanged
    double values_a_block = 0;
    double longest_delay = 1, longest_block = 1;
};

/// What a pixel of a job is, in these tests.
inline PixelValue pixel_of(JobId job, int x, int y) {
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(job)},
            static_cast<float>(x * 1000 + y)};
}

class RoleNetwork {
  public:
    RoleNetwork(const NetworkOptions& options, std::uint64_t seed)
        : options_(options),
          topology_(
              make_topology(options.variant, options.ranks, options.batch > 0, options.masters)),
          schedule_(seed) {
        std::vector<int> workers;
        for (const Topology::Worker& worker : topology_.workers) workers.push_back(worker.rank);
        ranks_.resize(static_cast<std::size_t>(options.ranks));
        at(0).master.emplace(Address{0, Role::master}, topology_.children, workers.size(),
                             BlockPolicy{options.block, options.stride,
                                         options.slots * static_cast<int>(workers.size())});
        for (const Topology::SubMaster& sub : topology_.sub_masters) {
            at(sub.rank).sub_master.emplace(
                Address{sub.rank, Role::master}, Address{0, Role::master}, sub.children,
                sub.children.size() * static_cast<std::size_t>(options.slots));
        }
        if (topology_.ambient_master)
            at(*topology_.ambient_master)
                .ambient_master.emplace(Address{*topology_.ambient_master, Role::ambient_master});
        const auto all = std::make_shared<const std::vector<int>>(workers);
        for (std::size_t i = 0; i < workers.size(); ++i) {
            Rank& rank = at(workers[i]);
            rank.worker.emplace(WorkerOptions{{workers[i], Role::worker},
                                              {topology_.workers[i].master, Role::master},
                                              i,
                                              all,
                                              options.slots,
                                              options.ahead,
                                              pack});
            rank.free_slots = options.slots;
            if (topology_.ambient_master) {
                rank.ambient_client.emplace(
                    Address{workers[i], Role::ambient_client},
                    Address{*topology_.ambient_master, Role::ambient_master}, options.batch);
            }
        }
        Outbox out;
        for (Rank& rank : ranks_) {
            if (rank.sub_master) rank.sub_master->begin(out);
            if (rank.worker) rank.worker->begin(out);
        }
        send(out);
    }

    void submit(JobStart job) {
        Outbox out{{{0, Role::program}, {0, Role::master}, std::move(job)}};
        send(out);
    }

    /// Until no message is on its way and nobody traces.
    void run() { schedule_.run(); }

    /// Every rank tells what it has not told, and then asks for what it does not know.
    void exchange_all() {
        for (int round = 0; round < 2; ++round) {
            for (Rank& rank : ranks_) {
                Outbox out;
                if (rank.ambient_client) rank.ambient_client->ask(out);
                send(out);
            }
            run();
        }
    }

    struct Rank {
        std::optional<MasterRole> master;
        std::optional<SubMasterRole> sub_master;
        std::optional<WorkerRole> worker;
        std::optional<AmbientMasterRole> ambient_master;
        std::optional<AmbientClientRole> ambient_client;
        int free_slots = 0;
        std::deque<JobBlock> blocks;
        std::map<JobId, JobStart> jobs;
        std::vector<std::uint32_t> values;  ///< ambient values that it knows, by their number
    };
    std::vector<FinishedPicture> pictures;
    std::map<JobId, double> shares;                     ///< last told
    std::map<std::tuple<JobId, int, int>, int> traced;  ///< how often each pixel was
    std::uint32_t values_made = 0;
    std::uint64_t messages_to_master = 0;
    [[nodiscard]] Rank& at(int rank) { return ranks_[static_cast<std::size_t>(rank)]; }
    [[nodiscard]] std::vector<Rank>& ranks() { return ranks_; }
    [[nodiscard]] const Topology& topology() const { return topology_; }

    static std::string pack(const PixelRectangle&, std::vector<PixelValue> values) {
        std::string bytes(values.size() * sizeof(PixelValue), '\0');
        std::memcpy(bytes.data(), values.data(), bytes.size());
        return bytes;
    }

  private:
    void send(Outbox& out) {
        for (const Envelope& envelope : out)
            if (envelope.to == Address{0, Role::master} && envelope.from.rank != 0)
                ++messages_to_master;
        schedule_.carry(out, options_.longest_delay,
                        [this](Envelope envelope) { deliver(std::move(envelope)); });
    }

    void deliver(Envelope envelope) {
        Rank& rank = at(envelope.to.rank);
        Outbox out;
        switch (envelope.to.role) {
            case Role::master:
                if (rank.sub_master)
                    rank.sub_master->handle(std::move(envelope), out);
                else
                    rank.master.value().handle(std::move(envelope), out);
                break;
            case Role::worker:
                rank.worker.value().handle(std::move(envelope), out);
                break;
            case Role::ambient_master:
                rank.ambient_master.value().handle(std::move(envelope), out);
                break;
            case Role::ambient_client:
                rank.ambient_client.value().handle(std::move(envelope), out);
                break;
            case Role::cache:
                for (const AmbientRecord& record :
                     std::get<AmbientValues>(envelope.message).records)
                    rank.values.push_back(record.normal);
                break;
            case Role::program:
                if (auto* picture = std::get_if<FinishedPicture>(&envelope.message))
                    pictures.push_back(std::move(*picture));
                else if (const auto* progress = std::get_if<Progress>(&envelope.message))
                    shares[progress->job] = progress->done;
                break;
            case Role::tracer:
                if (auto* job = std::get_if<JobStart>(&envelope.message))
                    rank.jobs[job->job] = *job;
                else
                    for (const JobBlock& block : std::get<GiveBlocks>(envelope.message).blocks)
                        rank.blocks.push_back(block);
                trace(envelope.to.rank);
        }
        send(out);
    }

    void trace(int number) {
        Rank& rank = at(number);
        while (rank.free_slots > 0 && !rank.blocks.empty()) {
            --rank.free_slots;
            const JobBlock work = rank.blocks.front();
            rank.blocks.pop_front();
            const double seconds = schedule_.uniform(options_.longest_block);
            schedule_.after(seconds,
                            [this, number, work, seconds] { finish(number, work, seconds); });
        }
    }

    void finish(int number, const JobBlock& work, double seconds) {
        Rank& rank = at(number);
        ++rank.free_slots;
        BlockDone done{{work, {}}, seconds};
        const bool keep = rank.jobs.at(work.job).keep;
        for (int y = work.block.y0; y < work.block.y1; ++y) {
            for (int x = work.block.x0; x < work.block.x1; ++x) {
                ++traced[{work.job, x, y}];
                if (keep) done.pixels.values.push_back(pixel_of(work.job, x, y));
            }
        }
        Outbox out;
        out.push_back({{number, Role::tracer}, {number, Role::worker}, std::move(done)});
        if (rank.ambient_client && schedule_.uniform(1) < options_.values_a_block) {
            AmbientRecord record;
            record.normal = values_made++;
            rank.values.push_back(record.normal);
            out.push_back(
                {{number, Role::cache}, {number, Role::ambient_client}, AmbientValues{{record}}});
        }
        send(out);
        trace(number);
    }

    NetworkOptions options_;
    Topology topology_;
    RandomSchedule schedule_;
    std::vector<Rank> ranks_;
};

}  // namespace lightwalk::test
