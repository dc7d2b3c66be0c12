#include "parallel/ranks/chunk_roles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "tests/parallel/ranks/random_schedule.h"

using namespace lightwalk;
using lightwalk::test::RandomSchedule;

namespace {

struct StreamOptions {
    int workers = 3, slots = 1, ahead = 1;
    std::uint32_t window = 8;
    std::uint64_t rays = 1000;
    std::uint64_t most_rays = 16;  ///< a chunk, whatever the master would like
    double longest_delay = 1, longest_chunk = 1;
    double longest_pause = 0;  ///< of the program, between two chunks that it reads
};

/// A stream of rays through the roles in one thread: tracing takes random times.
class Stream {
  public:
    Stream(const StreamOptions& options, std::uint64_t seed)
        : options_(options), schedule_(seed), master_({0, Role::master}, options.window) {
        Outbox out;
        master_.begin(out);
        for (int rank = 0; rank < options.workers; ++rank) {
            workers_.push_back({ChunkWorkerRole({rank, Role::worker}, {0, Role::master},
                                                options.slots, options.ahead),
                                {},
                                options.slots});
            workers_.back().role.begin(out);
        }
        send(out);
    }

    void run() { schedule_.run(); }

    std::string output;            ///< what the program got, in the order it came
    std::uint64_t most_open = 0;   ///< chunks that the program had no answer for, at most
    std::size_t most_waiting = 0;  ///< chunks at one worker, at most
    std::uint64_t given = 0, answered = 0;

  private:
    struct Worker {
        ChunkWorkerRole role;
        std::deque<RayChunk> chunks;
        int free_slots = 0;
    };

    void send(Outbox& out) {
        schedule_.carry(out, options_.longest_delay,
                        [this](Envelope envelope) { deliver(std::move(envelope)); });
    }

    void deliver(Envelope envelope) {
        Outbox out;
        if (envelope.to.role == Role::master) {
            master_.handle(std::move(envelope), out);
        } else if (envelope.to.role == Role::program) {
            tell_program(envelope.message);
        } else {
            Worker& worker = workers_[static_cast<std::size_t>(envelope.to.rank)];
            if (envelope.to.role == Role::worker) {
                worker.role.handle(std::move(envelope), out);
            } else {
                worker.chunks.push_back(std::get<RayChunk>(std::move(envelope.message)));
                most_waiting = std::max(most_waiting, worker.chunks.size());
                trace(envelope.to.rank);
            }
        }
        send(out);
    }

    void tell_program(const Message& message) {
        if (const auto* answer = std::get_if<ChunkAnswer>(&message)) {
            output += answer->bytes;
            ++answered;
            return;
        }
        const bool idle = wanted_ == 0;
        wanted_ += std::get<AskChunks>(message).chunks;
        if (idle) read();
    }

    void read() {
        if (wanted_ == 0 || read_ == options_.rays) return;
        const std::uint64_t count =
            std::min(1 + schedule_.number() % options_.most_rays, options_.rays - read_);
        RayChunk chunk{given++, read_, std::vector<double>(6 * count)};
        read_ += count;
        --wanted_;
        most_open = std::max(most_open, given - answered);
        Outbox out{{{0, Role::program}, {0, Role::master}, std::move(chunk)}};
        send(out);
        if (wanted_ > 0)
            schedule_.after(schedule_.uniform(options_.longest_pause), [this] { read(); });
    }

    void trace(int rank) {
        Worker& worker = workers_[static_cast<std::size_t>(rank)];
        while (worker.free_slots > 0 && !worker.chunks.empty()) {
            --worker.free_slots;
            ChunkAnswer answer{worker.chunks.front().number,
                               static_cast<std::uint32_t>(worker.chunks.front().rays()),
                               schedule_.uniform(options_.longest_chunk),
                               {}};
            for (std::uint64_t i = 0; i < answer.rays; ++i)
                answer.bytes += std::to_string(worker.chunks.front().first + i) + ' ';
            worker.chunks.pop_front();
            schedule_.after(answer.seconds, [this, rank, answer] {
                ++workers_[static_cast<std::size_t>(rank)].free_slots;
                Outbox out{{{rank, Role::tracer}, {rank, Role::worker}, answer}};
                send(out);
                trace(rank);
            });
        }
    }

    StreamOptions options_;
    RandomSchedule schedule_;
    ChunkMasterRole master_;
    std::vector<Worker> workers_;
    std::uint64_t read_ = 0;
    std::uint32_t wanted_ = 0;
};

StreamOptions some_options(std::mt19937_64& random) {
    const auto one_of = [&](std::initializer_list<int> list) {
        return *(list.begin() + static_cast<std::ptrdiff_t>(random() % list.size()));
    };
    StreamOptions options;
    options.workers = one_of({1, 2, 3, 8});
    options.slots = one_of({1, 2, 4});
    options.ahead = one_of({0, 1, 3});
    options.window = static_cast<std::uint32_t>(one_of({1, 2, 8, 4 * options.workers}));
    options.rays = static_cast<std::uint64_t>(one_of({0, 1, 30, 700}));
    options.most_rays = static_cast<std::uint64_t>(one_of({1, 5, 100}));
    options.longest_delay = one_of({0, 1, 10});
    options.longest_chunk = one_of({0, 1, 5});
    options.longest_pause = one_of({0, 0, 3});
    return options;
}

/// The master after `chunks` chunks of 64 rays, each of which took `seconds`.
std::uint32_t size_after(int chunks, double seconds) {
    ChunkMasterRole master({0, Role::master}, 4);
    Outbox out;
    for (int i = 0; i < chunks; ++i) {
        const auto number = static_cast<std::uint64_t>(i);
        master.handle({{1, Role::worker}, {0, Role::master}, ChunkAnswer{number, 64, seconds, ""}},
                      out);
    }
    return master.good_size();
}

}  // namespace

TEST_CASE(
    "a thousand schedules: no answer is lost, doubled or out of order, and the window is kept") {
    std::mt19937_64 random(1);
    for (int schedule = 0; schedule < 1000; ++schedule) {
        CAPTURE(schedule);
        const StreamOptions options = some_options(random);
        Stream stream(options, random());
        stream.run();
        std::string expected;
        for (std::uint64_t i = 0; i < options.rays; ++i) expected += std::to_string(i) + ' ';
        REQUIRE(stream.output == expected);
        CHECK(stream.given == stream.answered);
        CHECK(stream.most_open <= options.window);
        CHECK(stream.most_waiting <= static_cast<std::size_t>(options.slots + options.ahead));
    }
}

TEST_CASE("chunks begin small, and grow or shrink to what a fiftieth of a second takes") {
    CHECK(size_after(0, 0) == 64);
    CHECK(size_after(1, 0.064) == 64);            // a millisecond a ray
    CHECK(size_after(5, 64e-5) == 2000);          // ten microseconds
    CHECK(size_after(5, 64e-7) == 4096);          // no more than that
    CHECK(size_after(200, 64.0 / 20000) == 400);  // whatever the number of chunks
}
