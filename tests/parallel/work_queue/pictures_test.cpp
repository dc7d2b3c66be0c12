// Pictures and ambient values through the roles of all ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <set>

#include "tests/one_thread.h"
#include "tests/parallel/work_queue/rank_network.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

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
PixelValue value_of(JobId job, int x, int y) {
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(job)},
            static_cast<float>(x * 1000 + y)};
}

std::string pack(const PixelRectangle&, std::vector<PixelValue> values) {
    std::string bytes(values.size() * sizeof(PixelValue), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

RankSettings settings_of(const NetworkOptions& options) {
    RankSettings settings;
    settings.slots = options.slots;
    settings.ahead = options.ahead;
    settings.block = options.block;
    settings.stride = options.stride;
    settings.ambient_batch = options.batch;
    settings.encode = pack;
    return settings;
}

/// Tracing takes random times.
class PictureNetwork final : public RankNetwork {
  public:
    PictureNetwork(const NetworkOptions& options, std::uint64_t seed)
        : RankNetwork(
              make_topology(options.variant, options.ranks, options.batch > 0, options.masters),
              settings_of(options), options.longest_delay, seed),
          options_(options),
          threads_(options.ranks, options.slots, schedule()),
          tracers_(static_cast<std::size_t>(options.ranks)) {
        begin();
    }

    void submit(PictureJob job) {
        step(0, [&](RankRoles& roles, Outbox& out) { roles.queue().start(std::move(job), out); });
    }

    /// Every rank tells what it has not told, and then asks for what it does not know.
    void exchange_all() {
        for (int round = 0; round < 2; ++round) {
            for (int rank = 0; rank < options_.ranks; ++rank) {
                step(rank, [](RankRoles& roles, Outbox& out) {
                    if (roles.ambient_client()) roles.ambient_client()->ask(out);
                });
            }
            run();
        }
    }

    std::vector<FinishedPicture> pictures;
    std::map<JobId, double> shares;                     ///< last told
    std::map<std::tuple<JobId, int, int>, int> traced;  ///< how often each pixel was
    std::uint32_t values_made = 0;
    /// Ambient values that a rank knows, by their number.
    [[nodiscard]] const std::vector<std::uint32_t>& values(int rank) const {
        return tracers_[static_cast<std::size_t>(rank)].values;
    }

  private:
    struct Tracer {
        std::map<JobId, PictureJob> jobs;
        std::vector<std::uint32_t> values;
    };

    void take(int rank, TracerNews news) override {
        Tracer& tracer = tracers_[static_cast<std::size_t>(rank)];
        if (auto* job = std::get_if<PictureJob>(&news)) tracer.jobs[job->job] = *job;
        if (auto* grant = std::get_if<WorkGrant>(&news))
            for (const Work& piece : grant->pieces)
                threads_.waiting(rank).push_back(std::get<JobBlock>(piece));
        threads_.trace(
            rank, options_.longest_block,
            [this, rank](const JobBlock& work, double seconds) { finish(rank, work, seconds); });
    }
    void take(ProgramNews news) override {
        if (auto* picture = std::get_if<FinishedPicture>(&news))
            pictures.push_back(std::move(*picture));
        else if (const auto* progress = std::get_if<Progress>(&news))
            shares[progress->job] = progress->done;
    }
    void take(int rank, AmbientValues news) override {
        for (const AmbientRecord& record : news.records)
            tracers_[static_cast<std::size_t>(rank)].values.push_back(record.normal);
    }

    void finish(int rank, const JobBlock& work, double seconds) {
        Tracer& tracer = tracers_[static_cast<std::size_t>(rank)];
        Pixels pixels{work, {}};
        const bool keep = tracer.jobs.at(work.job).keep;
        for (int y = work.block.y0; y < work.block.y1; ++y) {
            for (int x = work.block.x0; x < work.block.x1; ++x) {
                ++traced[{work.job, x, y}];
                if (keep) pixels.values.push_back(value_of(work.job, x, y));
            }
        }
        const auto count = static_cast<std::uint32_t>(work.block.pixels());
        step(rank, [&](RankRoles& roles, Outbox& out) {
            roles.worker().finish({FinishedWork::Payload::block, work.job, count, seconds},
                                  std::move(pixels), out);
            if (!roles.ambient_client() || schedule().uniform(1) >= options_.values_a_block) return;
            AmbientRecord record;
            record.normal = values_made++;
            tracer.values.push_back(record.normal);
            roles.ambient_client()->offer({{record}}, out);
        });
    }

    NetworkOptions options_;
    TracingThreads<JobBlock> threads_;
    std::vector<Tracer> tracers_;
};

/// Every pixel of the picture is what was traced there, and was traced once.
void check_picture(const PictureNetwork& network, const FinishedPicture& picture,
                   const PixelRectangle& area) {
    std::set<std::pair<int, int>> seen;
    for (const PicturePart& part : picture.parts) {
        const PixelRectangle& block = part.work.block;
        REQUIRE(part.bytes.size() == block.pixels() * sizeof(PixelValue));
        std::vector<PixelValue> values(block.pixels());
        std::memcpy(values.data(), part.bytes.data(), part.bytes.size());
        std::size_t i = 0;
        for (int y = block.y0; y < block.y1; ++y) {
            for (int x = block.x0; x < block.x1; ++x, ++i) {
                REQUIRE(values[i] == value_of(picture.job, x, y));
                REQUIRE(seen.emplace(x, y).second);
                REQUIRE(network.traced.at({picture.job, x, y}) == 1);
            }
        }
    }
    CHECK(seen.size() == area.pixels());
}

NetworkOptions some_options(std::mt19937_64& random) {
    NetworkOptions options;
    options.variant = random() % 2 == 0 ? Variant::ranks : Variant::hybrid;
    options.ranks = one_of(random, {3, 4, 5, 9, 16});
    options.batch = static_cast<std::size_t>(one_of(random, {0, 1, 3}));
    options.masters = options.ranks >= 9 ? one_of(random, {1, 2, 3}) : 1;
    options.slots = options.variant == Variant::ranks ? 1 : one_of(random, {1, 2, 4});
    options.ahead = one_of(random, {0, 1, 3});
    options.block = one_of(random, {0, 0, 4, 16});
    options.stride = one_of(random, {0, 1, 7});
    options.values_a_block = .4;
    options.longest_delay = one_of(random, {0, 1, 10});
    options.longest_block = one_of(random, {1, 5});
    return options;
}

std::vector<JobBlock> blocks_of(const Outbox& out) {
    std::vector<JobBlock> blocks;
    for (const Envelope& envelope : out.messages)
        if (const auto* grant = std::get_if<WorkGrant>(&envelope.message))
            for (const Work& piece : grant->pieces) blocks.push_back(std::get<JobBlock>(piece));
    return blocks;
}

}  // namespace

TEST_CASE(
    "a thousand schedules: no pixel and no ambient value is lost or doubled, nobody waits for "
    "ever" *
    one_thread) {
    std::mt19937_64 random(1);
    for (int schedule = 0; schedule < 1000; ++schedule) {
        CAPTURE(schedule);
        const NetworkOptions options = some_options(random);
        PictureNetwork network(options, random());
        const PixelRectangle area{0, 0, 20 + static_cast<int>(random() % 20), 15};
        const PixelRectangle small{3, 2, 9, 5};
        // A sequence: the second picture begins while blocks of the first are out.
        network.submit({0, small, 1, false, "prepass", {}, false});
        network.submit({1, area, 4, true, "first", {}, false});
        network.submit({2, small, 1, true, "second", {}, false});
        network.run();
        network.exchange_all();  // everyone tells
        network.exchange_all();  // and hears
        REQUIRE(network.pictures.size() == 2);
        for (const FinishedPicture& picture : network.pictures)
            check_picture(network, picture, picture.job == 1 ? area : small);
        CHECK(network.shares[1] <= 1 + 1e-9);  // rounding of the sum
        for (int y = small.y0; y < small.y1; ++y) {
            for (int x = small.x0; x < small.x1; ++x) REQUIRE(network.traced.at({0, x, y}) == 1);
        }
        // Sub-queues tell what is finished with their next request.
        if (options.masters == 1) CHECK(network.roles(0).queue().blocks().blocks_out() == 0);
        for (int rank = 0; rank < options.ranks; ++rank) {
            if (!network.roles(rank).ambient_client()) continue;
            const std::vector<std::uint32_t>& values = network.values(rank);
            const std::set<std::uint32_t> known(values.begin(), values.end());
            CHECK(known.size() == network.values_made);
            CHECK(values.size() == network.values_made);
        }
    }
}

TEST_CASE("jobs may follow each other for ever") {
    NetworkOptions options;
    options.ranks = 4;
    PictureNetwork network(options, 3);
    for (JobId job = 0; job < 200; ++job) {
        network.submit({job, {0, 0, 12, 9}, 1, true, "", {}, false});
        if (job % 4 == 3) network.run();
    }
    network.run();
    CHECK(network.pictures.size() == 200);
}

TEST_CASE("blocks are handed out in strides, or one after the other") {
    const auto order = [](int stride) {
        WorkQueue queue({{1}, 1, {}, {8, stride, 1}, 1});
        Outbox out;
        queue.start(PictureJob{0, {0, 0, 64, 8}, 1, true, "", {}, false}, out);
        out = {};
        queue.handle(1, WorkRequest{8, {}}, out);
        std::vector<int> columns;
        for (const JobBlock& block : blocks_of(out)) columns.push_back(block.block.x0 / 8);
        return columns;
    };
    CHECK(order(1) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(order(3) == std::vector<int>{0, 3, 6, 1, 4, 7, 2, 5});
}

TEST_CASE("blocks whose size is left to the queue get smaller towards the end, and not too small") {
    WorkQueue queue({{1}, 1, {}, {0, 1, 4}, 1});
    Outbox out;
    queue.start(PictureJob{0, {0, 0, 256, 256}, 2, true, "", {}, false}, out);
    std::vector<std::size_t> sizes;
    std::vector<FinishedWork> finished;
    constexpr double kSecondsAPixel = 1e-4;  // so that .002 s are 20 pixels
    for (;;) {
        out = {};
        queue.handle(1, WorkRequest{1, finished}, out);
        const std::vector<JobBlock> given = blocks_of(out);
        if (given.empty()) break;
        const PixelRectangle& block = given.at(0).block;
        CHECK(block.x0 % 2 == 0);
        CHECK(block.y0 % 2 == 0);
        sizes.push_back(block.pixels());
        finished = {{FinishedWork::Payload::block, 0, static_cast<std::uint32_t>(block.pixels()),
                     kSecondsAPixel * static_cast<double>(block.pixels())}};
    }
    std::size_t sum = 0;
    for (const std::size_t size : sizes) sum += size;
    CHECK(sum == 256 * 256);
    CHECK(sizes.front() > 16 * sizes.back());
    CHECK(*std::min_element(sizes.begin(), sizes.end()) >= 4);
    CHECK(sizes.size() < 1000);
}

TEST_CASE(
    "where indirect light is looked for before a picture blocks are small, whatever --block says") {
    for (const int side : {0, 64}) {
        CAPTURE(side);
        WorkQueue queue({{1}, 1, {}, {side, 1, 6}, 1});
        Outbox out;
        queue.start(PictureJob{0, {0, 0, 27, 20}, 1, false, "", {}, false}, out);
        out = {};
        queue.handle(1, WorkRequest{12, {}}, out);
        const std::vector<JobBlock> given = blocks_of(out);
        REQUIRE(given.size() == 12);
        for (const JobBlock& one : given) CHECK(one.block.pixels() <= 8);
    }
}

TEST_CASE("where pixels make ambient values no block takes much of a small picture") {
    // Of a picture at its beginning: the largest of the blocks that threads get.
    const auto largest = [](int threads, const PixelRectangle& area, bool makes_values) {
        WorkQueue queue({{1, 2}, 2, {}, {0, 0, threads, makes_values}, 1});
        Outbox out;
        queue.start(PictureJob{0, area, 8, true, "", {}, false}, out);
        out = {};
        queue.handle(1, WorkRequest{20, {}}, out);
        std::size_t most = 0;
        for (const JobBlock& one : blocks_of(out)) most = std::max(most, one.block.pixels());
        return most;
    };
    const PixelRectangle small{0, 0, 160, 120}, large{0, 0, 800, 600};
    CHECK(largest(2, small, true) * 10 < 160 * 120);
    CHECK(largest(2, small, false) * 10 > 160 * 120);
    // Among many threads blocks are small by themselves.
    CHECK(largest(32, large, true) < largest(32, large, false));
    CHECK(largest(128, large, true) == largest(128, large, false));
}

TEST_CASE("sub-queues spare rank 0 messages") {
    NetworkOptions options;
    options.ranks = 40;
    options.block = 4;
    const auto messages = [&](int masters) {
        options.masters = masters;
        PictureNetwork network(options, 7);
        network.submit({0, {0, 0, 160, 120}, 1, true, "", {}, false});
        network.run();
        REQUIRE(network.pictures.size() == 1);
        return network.messages_to_rank_0;
    };
    CHECK(messages(4) < messages(1));
}
