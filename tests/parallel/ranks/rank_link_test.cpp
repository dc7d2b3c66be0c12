#include "parallel/ranks/rank_link.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>

#include "parallel/concurrent_cache.h"
#include "parallel/ranks/assembly.h"
#include "tests/parallel/ranks/memory_ranks.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const StopFlag kNever;

/// What a pixel of a job is, in these tests.
PixelValue value_of(JobId job, int x, int y) {
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(job)}, 1};
}

/// Traces what comes until no more does, at once.
void trace(RankLink& link) {
    if (!link.traces()) return link.inbox().wait_for_end(kNever);
    while (const auto item = link.inbox().next(kNever)) {
        if (const auto* chunk = std::get_if<RayChunk>(&*item))
            link.finish_work(
                {FinishedWork::Payload::rays, 0, static_cast<std::uint32_t>(chunk->rays()), 1e-3},
                RayAnswer{chunk->number, std::to_string(chunk->first)});
        const auto* block = std::get_if<TracerInbox::PictureBlock>(&*item);
        if (block == nullptr) continue;
        const JobBlock& work = block->work;
        Pixels pixels{work, {}};
        for (int y = work.block.y0; y < work.block.y1; ++y)
            for (int x = work.block.x0; x < work.block.x1; ++x)
                pixels.values.push_back(value_of(work.job, x, y));
        link.finish_work({FinishedWork::Payload::block, work.job,
                          static_cast<std::uint32_t>(work.block.pixels()), 1e-3},
                         std::move(pixels));
    }
}

/// `lead` on rank 0, while all trace.
void work_together(RankLink& link, const std::function<void()>& lead) {
    if (link.leads()) {
        std::jthread tracing([&] { trace(link); });
        link.guard([&] {
            lead();
            link.dismiss();
        });
    } else {
        trace(link);
    }
    link.end_work();
}

constexpr int kPictureWidth = 70, kPictureHeight = 50;

PictureJob job_of(JobId number) {
    return {number, {0, 0, kPictureWidth, kPictureHeight}, 1, true, "", {}, false};
}

/// Pictures that rank 0 gets, until there are so many.
std::map<JobId, FinishedPicture> wait_for_pictures(RankLink& link, std::size_t count) {
    std::map<JobId, FinishedPicture> pictures;
    while (pictures.size() < count)
        for (ProgramNews& news : link.take_news(true, kNever))
            if (auto* picture = std::get_if<FinishedPicture>(&news))
                pictures[picture->job] = std::move(*picture);
    return pictures;
}

bool is_right(const FinishedPicture& picture) {
    const Frame frame = assemble_picture(picture, kPictureWidth, kPictureHeight);
    for (int y = 0; y < kPictureHeight; ++y)
        for (int x = 0; x < kPictureWidth; ++x)
            if (frame.radiance[static_cast<std::size_t>((kPictureHeight - 1 - y) * kPictureWidth +
                                                        x)] != value_of(picture.job, x, y).radiance)
                return false;
    return true;
}

AmbientRecord record_of(int number) {
    AmbientRecord record;
    record.normal = static_cast<std::uint32_t>(number);
    record.radius = {.1F, .1F};
    return record;
}

/// Counts what it is given.
class CountingCache final : public AmbientCache {
  public:
    std::atomic<int> count{0};
    [[nodiscard]] const AmbientLimits& limits() const override { return limits_; }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery&, LeakTest) const override { return {}; }
    void insert(const AmbientRecord&) override { ++count; }
    [[nodiscard]] AmbientLogMean log_mean() const override { return {}; }

  private:
    AmbientLimits limits_;
};

double seconds_of(const std::function<void()>& task) {
    const auto begin = std::chrono::steady_clock::now();
    task();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    return took.count();
}

}  // namespace

TEST_CASE("rank link: pictures, two under way at once, and the end, for any number of ranks") {
    for (const int ranks : {1, 3, 6}) {
        CAPTURE(ranks);
        const Topology topology = make_topology(Variant::hybrid, ranks, true, ranks > 5 ? 2 : 1);
        std::atomic<int> right{0}, gathered{0};
        const RankOutcome outcome = run_ranks(topology, {}, [&](RankLink& link) {
            const auto all = link.all_gather(Collective::Group::all, std::to_string(link.rank()));
            bool same = static_cast<int>(all.size()) == ranks;
            for (std::size_t i = 0; same && i < all.size(); ++i) same = all[i] == std::to_string(i);
            gathered += same ? 1 : 0;
            work_together(link, [&] {
                for (JobId job = 0; job < 3; ++job) link.start({job_of(job)});
                for (const auto& [job, picture] : wait_for_pictures(link, 3))
                    right += picture.job == job && is_right(picture) ? 1 : 0;
            });
            const RankReport report = link.report();
            CHECK(report.host == "memory");
            CHECK(report.rows.size() == 2);
        });
        CHECK(all_well(outcome));
        CHECK(gathered == ranks);
        CHECK(right == 3);
    }
}

TEST_CASE("rank link: works follow each other, and pictures of a new one are its own") {
    std::atomic<int> right{0};
    const RankOutcome outcome =
        run_ranks(make_topology(Variant::ranks, 4, false, 1), {}, [&](RankLink& link) {
            for (int work = 0; work < 5; ++work) {
                work_together(link, [&] {
                    const JobId job = link.new_number();
                    link.start({job_of(job)});
                    right += is_right(wait_for_pictures(link, 1).at(job)) ? 1 : 0;
                });
            }
        });
    CHECK(all_well(outcome));
    CHECK(right == 5);
}

TEST_CASE("rank link: rays are asked for as they are answered, and answered in their order") {
    constexpr std::uint64_t kChunks = 40;
    RankSettings settings;
    settings.rays = true;
    std::vector<std::string> answers;
    const RankOutcome outcome =
        run_ranks(make_topology(Variant::ranks, 4, false, 1), settings, [&](RankLink& link) {
            work_together(link, [&] {
                std::uint64_t wanted = 0, given = 0;
                while (answers.size() < kChunks) {
                    for (; wanted > 0 && given < kChunks; --wanted, ++given)
                        link.add({given, 7 * given, std::vector<double>(6)});
                    for (ProgramNews& news : link.take_news(true, kNever)) {
                        if (const auto* more = std::get_if<ChunksWanted>(&news))
                            wanted += more->chunks;
                        if (const auto* answer = std::get_if<RayAnswer>(&news))
                            answers.push_back(answer->bytes);
                    }
                }
            });
        });
    CHECK(all_well(outcome));
    for (std::uint64_t i = 0; i < kChunks; ++i) CHECK(answers[i] == std::to_string(7 * i));
}

TEST_CASE("rank link: ambient values that do not make a batch reach rank 0 all the same") {
    for (const Variant variant : {Variant::hybrid, Variant::ranks}) {
        constexpr int kRanks = 4, kWorks = 3;
        std::atomic<int> heard{0};
        RankSettings settings;
        settings.ambient_batch = 16;
        const RankOutcome outcome =
            run_ranks(make_topology(variant, kRanks, true, 1), settings, [&](RankLink& link) {
                for (int work = 0; work < kWorks; ++work) {
                    CountingCache values;
                    PublishedCache cache(values);
                    link.agree({}, "");
                    link.share(cache);
                    for (int i = 0; i < 3; ++i) cache.insert(record_of(3 * link.rank() + i));
                    work_together(link, [] {});
                    if (link.leads()) heard += values.count;  // and of no work before
                }
            });
        CHECK(all_well(outcome));
        CHECK(heard == kWorks * 3 * kRanks);
    }
}

TEST_CASE("rank link: a rank whose program fails ends the run, and rank 0 says which and why") {
    for (const int victim : {0, 1, 3}) {
        CAPTURE(victim);
        RankOutcome outcome;
        const double seconds = seconds_of([&] {
            outcome =
                run_ranks(make_topology(Variant::hybrid, 4, true, 1), {}, [&](RankLink& link) {
                    if (link.rank() == victim) throw std::runtime_error("no more \x01 paper");
                    work_together(link, [&] {  // for ever
                        link.start({job_of(link.new_number())});
                        (void)wait_for_pictures(link, 2);
                    });
                });
        });
        CHECK(seconds < 2);
        CHECK(outcome.failures == std::vector<std::string>{"test: rank " + std::to_string(victim) +
                                                           " (memory): no more \\x01 paper"});
        CHECK(outcome.problems == std::vector<std::string>(4, "aborted"));
    }
}

namespace {

/// A rank that does not answer any more: what is sent to it, or by it, is lost.
class DeadCommunicator final : public Communicator {
  public:
    explicit DeadCommunicator(std::unique_ptr<Communicator> wire) : wire_(std::move(wire)) {}
    [[nodiscard]] int rank() const override { return wire_->rank(); }
    [[nodiscard]] int size() const override { return wire_->size(); }
    [[nodiscard]] std::string host() const override { return wire_->host(); }
    [[nodiscard]] bool on_one_machine() const override { return true; }
    [[nodiscard]] int first_on_machine() const override { return 0; }
    void send(int, std::string) override {}
    [[nodiscard]] std::optional<Packet> receive() override {
        (void)wire_->receive();  // throws when another rank has aborted
        return std::nullopt;
    }
    void wait(std::chrono::microseconds most) override { wire_->wait(most); }
    void wake() override { wire_->wake(); }
    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        return wire_->broadcast(std::move(bytes), meanwhile);
    }
    void flush() override {}
    [[noreturn]] void abort(int status) override {
        wire_->abort(status);
        std::terminate();
    }

  private:
    std::unique_ptr<Communicator> wire_;
};

/// Every rank has a machine of its own.
class FarCommunicator final : public Communicator {
  public:
    explicit FarCommunicator(std::unique_ptr<Communicator> wire) : wire_(std::move(wire)) {}
    [[nodiscard]] int rank() const override { return wire_->rank(); }
    [[nodiscard]] int size() const override { return wire_->size(); }
    [[nodiscard]] std::string host() const override { return wire_->host(); }
    [[nodiscard]] bool on_one_machine() const override { return false; }
    [[nodiscard]] int first_on_machine() const override { return rank(); }
    void send(int to, std::string bytes) override { wire_->send(to, std::move(bytes)); }
    [[nodiscard]] std::optional<Packet> receive() override { return wire_->receive(); }
    void wait(std::chrono::microseconds most) override { wire_->wait(most); }
    void wake() override { wire_->wake(); }
    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        return wire_->broadcast(std::move(bytes), meanwhile);
    }
    void flush() override {}
    [[noreturn]] void abort(int status) override {
        wire_->abort(status);
        std::terminate();
    }

  private:
    std::unique_ptr<Communicator> wire_;
};

}  // namespace

TEST_CASE("rank link: where rank 0 does not answer, the rank that fails ends the run itself") {
    Wires wires = make_memory_communicators(3);
    wires[0] = std::make_unique<DeadCommunicator>(std::move(wires[0]));
    RankOutcome outcome;
    const double seconds = seconds_of([&] {
        outcome = run_ranks(
            make_topology(Variant::hybrid, 3, false, 1), {},
            [](RankLink& link) {
                if (link.rank() == 2) throw std::runtime_error("lost");
                (void)link.all_gather(Collective::Group::all, "");
            },
            std::move(wires));
    });
    CHECK(seconds < 2);
    CHECK(outcome.failures == std::vector<std::string>{"test: rank 2 (memory): lost"});
    CHECK(outcome.problems == std::vector<std::string>(3, "aborted"));
}

TEST_CASE("rank link: on several machines a rank that is not heard of any more ends the run") {
    Wires wires = make_memory_communicators(3);
    for (auto& wire : wires) wire = std::make_unique<FarCommunicator>(std::move(wire));
    RankSettings settings;
    settings.pulse = {std::chrono::milliseconds(10), std::chrono::milliseconds(300)};
    std::atomic<bool> over{false};
    const RankOutcome outcome = run_ranks(
        make_topology(Variant::hybrid, 3, false, 1), settings,
        [&](RankLink& link) {
            link.agree({}, "");
            (void)link.all_gather(Collective::Group::all, "");
            if (link.rank() == 2) {  // the thread that serves its messages is busy for ever
                link.post(Activity::handle, [&](RankRoles&, Outbox&) {
                    while (!over) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                });
            }
            try {
                (void)link.all_gather(Collective::Group::all, "");
            } catch (const Aborted&) {
                over = true;
                throw;
            }
        },
        std::move(wires));
    REQUIRE_FALSE(outcome.failures.empty());
    CHECK(outcome.failures[0].find("nothing has been heard of it") != std::string::npos);
    CHECK(outcome.problems == std::vector<std::string>(3, "aborted"));
}

TEST_CASE("rank link: a thread that fails while others trace ends the run as well") {
    const RankOutcome outcome =
        run_ranks(make_topology(Variant::ranks, 3, false, 1), {}, [](RankLink& link) {
            if (link.rank() != 2) {
                work_together(link, [&] {
                    link.start({job_of(link.new_number())});
                    (void)wait_for_pictures(link, 1);
                });
                return;
            }
            std::jthread tracing([&] {
                try {
                    link.guard([&] {
                        while (link.inbox().next(kNever)) {
                        }
                        throw std::runtime_error("nowhere.cal:1: what is wrong");
                    });
                } catch (const Aborted&) {
                }
            });
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            link.inbox().close();
            (void)link.all_gather(Collective::Group::all, "");
        });
    CHECK(outcome.failures ==
          std::vector<std::string>{"test: rank 2 (memory): nowhere.cal:1: what is wrong"});
}

TEST_CASE("rank link: bytes that are no message end the run") {
    const RankOutcome outcome =
        run_ranks(make_topology(Variant::hybrid, 3, false, 1), {}, [](RankLink& link) {
            if (link.rank() == 1) link.post(2, Notice{Failure{"node", "not for rank 2"}});
            if (link.rank() == 0) link.post(1, UncachedPixels{});  // which only queues take
            (void)link.all_gather(Collective::Group::all, "");
            link.inbox().wait_for_end(kNever);
        });
    REQUIRE(!outcome.failures.empty());
    CHECK(outcome.problems == std::vector<std::string>(3, "aborted"));
}

TEST_CASE("rank link: a request to stop ends the run, and all who wait in it") {
    StopFlag stop;
    std::thread stopping([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stop.request();
    });
    RankOutcome outcome;
    const double seconds = seconds_of([&] {
        outcome = run_ranks(
            make_topology(Variant::hybrid, 3, false, 1), {},
            [](RankLink& link) {
                if (link.rank() == 2) return link.inbox().wait_for_end(kNever);
                (void)link.all_gather(Collective::Group::workers, "without rank 2");
            },
            stop);
    });
    stopping.join();
    CHECK(seconds < 2);
    CHECK(outcome.failures.empty());
    CHECK(outcome.problems == std::vector<std::string>(3, "aborted"));
}

TEST_CASE("rank link: ranks agree, or all hear that they do not, and rank 0 of what") {
    const Topology topology = make_topology(Variant::hybrid, 3, false, 1);
    using Say = std::function<void(RankLink&)>;
    const auto told = [&](const Say& say) { return run_ranks(topology, {}, say).problems; };
    CHECK(told([](RankLink& link) {
              link.agree({"version", "a"}, "");
          }) == std::vector<std::string>(3));
    const std::vector<std::string> differ = told([](RankLink& link) {
        link.agree({"version", link.rank() == 2 ? "b" : "a", "c"}, "");
    });
    CHECK(differ[0] == "agreed: test: rank 2 (memory): b, but rank 0 (memory) has a");
    CHECK(differ[1] == "agreed: ");
    CHECK(differ[2] == "agreed: ");
    // What all find is said once, and as it is; what others find, with their ranks and the advice.
    CHECK(told([](RankLink& link) { link.agree({}, "a.rad:1: wrong", "advice"); })[0] ==
          "agreed: a.rad:1: wrong");
    CHECK(told([](RankLink& link) {
              link.agree({}, link.rank() > 0 ? "a.rad: missing" : "", "advice");
          })[0] == "agreed: test: rank 1 (memory): a.rad: missing\nadvice");
    CHECK(told([](RankLink& link) {
              link.agree({}, link.rank() == 0 ? "one" : "other", "advice");
          })[0] == "agreed: test: rank 0 (memory): one\ntest: rank 1 (memory): other");
}

TEST_CASE("rank link: rank 0's bytes reach every rank, also while its messages are served") {
    constexpr int kRanks = 3;
    std::atomic<int> right{0};
    const RankOutcome outcome =
        run_ranks(make_topology(Variant::hybrid, kRanks, false, 1), {}, [&](RankLink& link) {
            for (const char* word : {"", "second", "third"}) {
                right += link.broadcast(link.leads() ? word : "") == word ? 1 : 0;
                right += link.all_gather(Collective::Group::all, word).size() == kRanks ? 1 : 0;
            }
        });
    CHECK(all_well(outcome));
    CHECK(right == 6 * kRanks);
}

TEST_CASE("rank link: ranks that trace gather among themselves, while the others serve") {
    constexpr int kRanks = 5;
    const Topology topology = make_topology(Variant::ranks, kRanks, true, 1);  // two do not trace
    std::atomic<int> good{0};
    const RankOutcome outcome = run_ranks(topology, {}, [&](RankLink& link) {
        bool same = link.all_gather(Collective::Group::all, "x").size() == kRanks;
        for (int round = 0; link.traces() && round < 20; ++round) {
            const auto all = link.workers().all_gather(std::to_string(100 * round + link.rank()));
            same = same && all.size() == topology.workers.size();
            for (std::size_t i = 0; same && i < all.size(); ++i)
                same = all[i] == std::to_string(100 * round + topology.workers[i].rank);
        }
        // Groups may take turns, and numbers are added up.
        same = same && link.all_gather(Collective::Group::all, "y").size() == kRanks;
        if (link.traces()) {
            const auto own = static_cast<std::uint64_t>(link.rank());
            same = same &&
                   link.workers().all_reduce({own, 1}) == std::vector<std::uint64_t>{2 + 3 + 4, 3};
            CHECK(link.workers().size() == 3);
            CHECK(link.workers().index() == link.rank() - 2);
        }
        // Rank 0 hears what comes of their rounds.
        if (link.traces() || link.leads()) {
            CHECK(link.rounds().index() == (link.leads() ? -1 : link.rank() - 2));
            same = same && link.rounds().all_gather(std::to_string(link.rank())) ==
                               std::vector<std::string>{"2", "3", "4", "0"};
        }
        good += same ? 1 : 0;
    });
    CHECK(all_well(outcome));
    CHECK(topology.workers.size() == 3);
    CHECK(good == kRanks);
}

TEST_CASE("abort reaches every rank") {
    const auto communicators = make_memory_communicators(3);
    CHECK_THROWS_AS(communicators[1]->abort(1), Aborted);
    CHECK_THROWS_AS((void)communicators[0]->receive(), Aborted);
    CHECK_THROWS_AS((void)communicators[2]->receive(), Aborted);
}
