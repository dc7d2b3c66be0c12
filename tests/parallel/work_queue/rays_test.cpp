// A stream of rays through the roles of all ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "tests/one_thread.h"
#include "tests/parallel/work_queue/rank_network.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

struct StreamOptions {
    int workers = 3, slots = 1, ahead = 1;
    std::uint64_t rays = 1000;
    std::uint64_t most_rays = 16;  ///< a chunk, whatever the queue would like
    double longest_delay = 1, longest_chunk = 1;
    double longest_pause = 0;  ///< of the program, between two chunks that it reads
};

RankSettings settings_of(const StreamOptions& options) {
    RankSettings settings;
    settings.slots = options.slots;
    settings.ahead = options.ahead;
    settings.rays = true;
    return settings;
}

/// Tracing takes random times.
class Stream final : public RankNetwork {
  public:
    Stream(const StreamOptions& options, std::uint64_t seed)
        : RankNetwork(make_topology(Variant::hybrid, options.workers, false, 1),
                      settings_of(options), options.longest_delay, seed),
          options_(options),
          threads_(options.workers, options.slots, schedule()) {
        begin();
    }

    std::string output;            ///< what the program got, in the order it came
    std::uint64_t most_open = 0;   ///< chunks that the program had no answer for, at most
    std::size_t most_waiting = 0;  ///< chunks at one worker, at most
    std::uint64_t given = 0, answered = 0;
    std::uint32_t window = 0;  ///< chunks that were wanted at first

  private:
    void take(int rank, TracerNews news) override {
        std::deque<RayChunk>& waiting = threads_.waiting(rank);
        for (Work& piece : std::get<WorkGrant>(news).pieces)
            waiting.push_back(std::get<RayChunk>(std::move(piece)));
        most_waiting = std::max(most_waiting, waiting.size());
        threads_.trace(
            rank, options_.longest_chunk,
            [this, rank](const RayChunk& chunk, double seconds) { finish(rank, chunk, seconds); });
    }

    void take(ProgramNews news) override {
        if (const auto* answer = std::get_if<RayAnswer>(&news)) {
            output += answer->bytes;
            ++answered;
            return;
        }
        const bool idle = wanted_ == 0;
        wanted_ += std::get<ChunksWanted>(news).chunks;
        window = std::max(window, wanted_);
        // A program reads on after the news, not while they are told.
        if (idle) schedule().after(0, [this] { read(); });
    }

    void read() {
        if (wanted_ == 0 || read_ == options_.rays) return;
        const std::uint64_t count =
            std::min(1 + schedule().number() % options_.most_rays, options_.rays - read_);
        RayChunk chunk{given++, read_, std::vector<double>(6 * count)};
        read_ += count;
        --wanted_;
        most_open = std::max(most_open, given - answered);
        step(0, [&](RankRoles& roles, Outbox& out) { roles.queue().add(std::move(chunk), out); });
        if (wanted_ > 0)
            schedule().after(schedule().uniform(options_.longest_pause), [this] { read(); });
    }

    void finish(int rank, const RayChunk& chunk, double seconds) {
        RayAnswer answer{chunk.number, {}};
        for (std::uint64_t i = 0; i < chunk.rays(); ++i)
            answer.bytes += std::to_string(chunk.first + i) + ' ';
        const auto count = static_cast<std::uint32_t>(chunk.rays());
        step(rank, [&](RankRoles& roles, Outbox& out) {
            roles.worker().finish({FinishedWork::Payload::rays, 0, count, seconds},
                                  std::move(answer), out);
        });
    }

    StreamOptions options_;
    TracingThreads<RayChunk> threads_;
    std::uint64_t read_ = 0;
    std::uint32_t wanted_ = 0;
};

StreamOptions some_stream(std::mt19937_64& random) {
    StreamOptions options;
    options.workers = one_of(random, {1, 2, 3, 8});
    options.slots = one_of(random, {1, 2, 4});
    options.ahead = one_of(random, {0, 1, 3});
    options.rays = static_cast<std::uint64_t>(one_of(random, {0, 1, 30, 700}));
    options.most_rays = static_cast<std::uint64_t>(one_of(random, {1, 5, 100}));
    options.longest_delay = one_of(random, {0, 1, 10});
    options.longest_chunk = one_of(random, {0, 1, 5});
    options.longest_pause = one_of(random, {0, 0, 3});
    return options;
}

/// After `chunks` chunks of 64 rays, each of which took `seconds`.
std::uint32_t size_after(int chunks, double seconds) {
    RaySupply supply(4);
    for (int i = 0; i < chunks; ++i) supply.note({FinishedWork::Payload::rays, 0, 64, seconds});
    return supply.good_size();
}

}  // namespace

TEST_CASE(
    "a thousand schedules: no answer is lost, doubled or out of order, and the window is kept" *
    one_thread) {
    std::mt19937_64 random(1);
    for (int schedule = 0; schedule < 1000; ++schedule) {
        CAPTURE(schedule);
        const StreamOptions options = some_stream(random);
        Stream stream(options, random());
        stream.run();
        std::string expected;
        for (std::uint64_t i = 0; i < options.rays; ++i) expected += std::to_string(i) + ' ';
        REQUIRE(stream.output == expected);
        CHECK(stream.given == stream.answered);
        CHECK(stream.window == static_cast<std::uint32_t>(4 * options.workers * options.slots));
        CHECK(stream.most_open <= stream.window);
        CHECK(stream.most_waiting <= static_cast<std::size_t>(options.slots + options.ahead));
    }
}

TEST_CASE("a window of rays is never exceeded, and answers come in their order") {
    for (const std::uint32_t window : {1U, 2U, 8U}) {
        RaySupply supply(window);
        Outbox out;
        supply.begin(out);
        CHECK(std::get<ChunksWanted>(out.program.at(0)).chunks == window);
        // The last chunk of the window is answered first: nothing is passed on, or wanted.
        for (std::uint32_t number = window; number-- > 1;) {
            out = {};
            supply.gather({number, "x"}, out);
            CHECK(out.program.empty());
        }
        out = {};
        supply.gather({0, "x"}, out);
        REQUIRE(out.program.size() == window + 1);
        for (std::uint32_t number = 0; number < window; ++number)
            CHECK(std::get<RayAnswer>(out.program[number]).number == number);
        CHECK(std::get<ChunksWanted>(out.program.back()).chunks == window);
    }
}

TEST_CASE("chunks begin small, and grow or shrink to what a fiftieth of a second takes") {
    CHECK(size_after(0, 0) == 64);
    CHECK(size_after(1, 0.064) == 64);            // a millisecond a ray
    CHECK(size_after(5, 64e-5) == 2000);          // ten microseconds
    CHECK(size_after(5, 64e-7) == 4096);          // no more than that
    CHECK(size_after(200, 64.0 / 20000) == 400);  // whatever the number of chunks
}
