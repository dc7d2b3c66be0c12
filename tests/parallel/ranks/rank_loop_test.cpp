#include "parallel/ranks/rank_loop.h"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>
#include <utility>

using namespace lightwalk;

namespace {

/// Traces at once, on the thread that serves messages; keeps what it is told.
class Ends final : public LocalEnd {
  public:
    RankLoop* loop = nullptr;
    std::vector<FinishedPicture> pictures;
    std::atomic<int> pictures_there{0};
    std::vector<AmbientRecord> unsent;  ///< values that were made here
    std::size_t heard = 0;              ///< values of others

    [[nodiscard]] AmbientValues unsent_values() override { return {std::exchange(unsent, {}), 0}; }
    void take(TracerNews news) override {
        const auto* grant = std::get_if<WorkGrant>(&news);
        if (grant == nullptr) return;
        for (const Work& piece : grant->pieces) {
            const auto work = std::get<JobBlock>(piece);
            loop->post(Activity::send, [work](RankRoles& roles, Outbox& out) {
                const std::size_t count = work.block.pixels();
                roles.worker().finish({FinishedWork::Payload::block, work.job,
                                       static_cast<std::uint32_t>(count), 1e-3},
                                      Pixels{work, std::vector<PixelValue>(count)}, out);
            });
        }
    }
    void take(ProgramNews news) override {
        if (auto* picture = std::get_if<FinishedPicture>(&news)) {
            pictures.push_back(std::move(*picture));
            ++pictures_there;
        } else if (std::holds_alternative<RankNotice>(news)) {
            loop->end();
        }
    }
    void take(AmbientValues news) override { heard += news.records.size(); }
};

std::string no_bytes(const PixelRectangle&, std::vector<PixelValue>) {
    return {};
}

}  // namespace

TEST_CASE("ranks that are threads render a picture over the wire, gather and say goodbye") {
    for (const int ranks : {1, 3, 6}) {
        CAPTURE(ranks);
        const Topology topology = make_topology(Variant::hybrid, ranks, true, ranks > 5 ? 2 : 1);
        const auto communicators = make_memory_communicators(ranks);
        const StopFlag never;
        std::vector<std::thread> threads;
        std::atomic<int> good{0}, gathered{0};
        for (int rank = 0; rank < ranks; ++rank) {
            threads.emplace_back([&, rank] {
                Ends ends;
                RankSettings settings;
                settings.encode = no_bytes;
                RankLoop loop(*communicators[static_cast<std::size_t>(rank)], topology, settings,
                              ends);
                ends.loop = &loop;
                ends.unsent.resize(3);  // not enough for a batch
                std::thread program([&] {
                    const std::vector<std::string> all =
                        loop.all_gather(Collective::Group::all, std::to_string(rank));
                    bool same = static_cast<int>(all.size()) == ranks;
                    for (int i = 0; i < ranks; ++i)
                        same = same && all[static_cast<std::size_t>(i)] == std::to_string(i);
                    gathered += same ? 1 : 0;
                    if (rank != 0) return;
                    for (JobId job = 0; job < 3; ++job)
                        loop.post(Activity::serve, [job](RankRoles& roles, Outbox& out) {
                            roles.queue().start(
                                PictureJob{job, {0, 0, 70, 50}, 1, true, "", {}, false}, out);
                        });
                    while (ends.pictures_there < 3) std::this_thread::yield();
                    for (int to = 0; to < ranks; ++to) loop.post(to, Notice{Finish{}});
                });
                good += loop.run(never) ? 1 : 0;
                program.join();
                if (rank == 0) {
                    CHECK(ends.pictures.size() == 3);
                    CHECK(ends.heard == 3 * static_cast<std::size_t>(ranks - 1));
                }
            });
        }
        for (std::thread& thread : threads) thread.join();
        CHECK(good == ranks);
        CHECK(gathered == ranks);
    }
}

TEST_CASE("rank 0's bytes reach every rank, also while its messages are served") {
    constexpr int kRanks = 3;
    const Topology topology = make_topology(Variant::hybrid, kRanks, false, 1);
    const auto communicators = make_memory_communicators(kRanks);
    const StopFlag never;
    std::atomic<int> right{0};
    std::vector<std::thread> threads;
    for (int rank = 0; rank < kRanks; ++rank) {
        threads.emplace_back([&, rank] {
            Communicator& communicator = *communicators[static_cast<std::size_t>(rank)];
            right += communicator.broadcast(rank == 0 ? "first" : "nobody's") == "first" ? 1 : 0;
            Ends ends;
            RankSettings settings;
            settings.encode = no_bytes;
            RankLoop loop(communicator, topology, settings, ends);
            ends.loop = &loop;
            std::thread program([&] {
                for (const char* word : {"", "second", "third"}) {
                    const std::string own = rank == 0 ? word : "";
                    right += loop.broadcast(own) == word ? 1 : 0;
                    right += loop.all_gather(Collective::Group::all, word).size() == kRanks ? 1 : 0;
                }
                loop.end();
            });
            (void)loop.run(never);
            program.join();
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(right == 7 * kRanks);
}

TEST_CASE("a loop that is stopped ends, and so does who waits for a round") {
    const auto communicators = make_memory_communicators(2);
    const Topology topology = make_topology(Variant::hybrid, 2, false, 1);
    StopFlag stop;
    Ends ends;
    RankSettings settings;
    settings.encode = no_bytes;
    RankLoop loop(*communicators[0], topology, settings, ends);
    ends.loop = &loop;
    std::atomic<bool> thrown{false};
    std::thread waiting([&] {
        try {
            (void)loop.all_gather(Collective::Group::all, "alone");
        } catch (const Aborted&) {
            thrown = true;
        }
    });
    std::thread stopping([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stop.request();
    });
    CHECK_FALSE(loop.run(stop));
    waiting.join();
    stopping.join();
    CHECK(thrown);
}

TEST_CASE("abort reaches every rank") {
    const auto communicators = make_memory_communicators(3);
    CHECK_THROWS_AS(communicators[1]->abort(1), Aborted);
    CHECK_THROWS_AS((void)communicators[0]->receive(), Aborted);
    CHECK_THROWS_AS((void)communicators[2]->receive(), Aborted);
}

TEST_CASE("ranks that trace gather among themselves, while the others serve") {
    constexpr int kRanks = 5;
    const Topology topology = make_topology(Variant::ranks, kRanks, true, 1);  // two do not trace
    const auto communicators = make_memory_communicators(kRanks);
    const StopFlag never;
    std::vector<std::thread> threads;
    std::atomic<int> good{0};
    for (int rank = 0; rank < kRanks; ++rank) {
        threads.emplace_back([&, rank] {
            Ends ends;
            RankSettings settings;
            settings.encode = no_bytes;
            RankLoop loop(*communicators[static_cast<std::size_t>(rank)], topology, settings, ends);
            ends.loop = &loop;
            std::thread program([&] {
                bool same = loop.all_gather(Collective::Group::all, "x").size() == kRanks;
                for (int round = 0; topology.traces(rank) && round < 20; ++round) {
                    const auto all = loop.all_gather(Collective::Group::workers,
                                                     std::to_string(100 * round + rank));
                    same = same && all.size() == topology.workers.size();
                    for (std::size_t i = 0; same && i < all.size(); ++i)
                        same = all[i] == std::to_string(100 * round + topology.workers[i].rank);
                }
                // Groups may take turns, and numbers are added up.
                same = same && loop.all_gather(Collective::Group::all, "y").size() == kRanks;
                if (topology.traces(rank)) {
                    const auto own = static_cast<std::uint64_t>(rank);
                    same = same && loop.all_reduce(Collective::Group::workers, {own, 1}) ==
                                       std::vector<std::uint64_t>{2 + 3 + 4, 3};
                }
                good += same ? 1 : 0;
                loop.end();
            });
            CHECK(loop.run(never));
            program.join();
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(topology.workers.size() == 3);
    CHECK(good == kRanks);
}
