#include "parallel/ranks/cloud_roles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "tests/parallel/ranks/random_schedule.h"

using namespace lightwalk;
using lightwalk::test::RandomSchedule;

namespace {

constexpr int kWidth = 40, kHeight = 30;

struct WalkOptions {
    int workers = 3, slots = 1, ahead = 1;
    std::size_t owners = 3;
    std::uint64_t frames = 3;
    int most_uncached = 200, most_noise_pairs = 5;
};

/// A walk through the roles in one thread: all that ranks do takes random times.
class Walk {
  public:
    Walk(const WalkOptions& options, std::uint64_t seed)
        : options_(options),
          schedule_(seed),
          master_({0, Role::master}, ranks_of(options), options.owners,
                  options.workers * options.slots) {
        Outbox out;
        for (int rank = 0; rank < options.workers; ++rank) {
            const auto index = static_cast<std::size_t>(rank);
            ranks_.push_back({CloudWorkerRole({{rank, Role::worker},
                                               {0, Role::master},
                                               index,
                                               options.owners,
                                               options.slots,
                                               options.ahead}),
                              {},
                              options.slots,
                              false});
            ranks_.back().role.begin(out);
        }
        order(out);
        send(out);
        schedule_.run();
    }

    /// Owner, frame, number of the pixel: how often it was traced.
    std::map<std::tuple<std::size_t, std::uint64_t, std::size_t>, int> traced;
    std::size_t expected = 0;  ///< pixels that should have been
    std::uint64_t finished = 0;
    std::size_t ends = 0;          ///< of frames, told to tracers
    std::size_t pixel_stages = 0;  ///< told

  private:
    struct Rank {
        CloudWorkerRole role;
        std::deque<GiveUncachedPixels> uncached;
        int free_slots = 1;
        bool points_there = false;
    };

    static std::vector<int> ranks_of(const WalkOptions& options) {
        std::vector<int> ranks(static_cast<std::size_t>(options.workers));
        for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = static_cast<int>(i);
        return ranks;
    }
    static CloudPart part_of(std::uint64_t frame) {
        CloudPart part;
        part.frame = frame;
        return part;
    }
    void order(Outbox& out) {
        CloudOrder order;
        order.width = kWidth;
        order.height = kHeight;
        order.rules.frame = finished;
        out.push_back({{0, Role::program}, {0, Role::master}, std::move(order)});
    }

    void send(Outbox& out) {
        schedule_.carry(out, 1, [this](Envelope envelope) { deliver(std::move(envelope)); });
    }

    void deliver(Envelope envelope) {
        Outbox out;
        const int rank = envelope.to.rank;
        if (envelope.to.role == Role::master) {
            master_.handle(std::move(envelope), out);
        } else if (envelope.to.role == Role::program) {
            CHECK(std::get<FinishedFrame>(envelope.message).parts.size() == options_.owners);
            ++finished;
            if (finished < options_.frames) order(out);
        } else if (envelope.to.role == Role::worker) {
            ranks_[static_cast<std::size_t>(rank)].role.handle(std::move(envelope), out);
        } else {
            tell_tracer(rank, std::move(envelope.message));
        }
        send(out);
    }

    void post(int rank, double delay, Address to, Message message) {
        auto out = std::make_shared<Outbox>();
        out->push_back({{rank, Role::tracer}, to, std::move(message)});
        schedule_.after(delay, [this, out] { send(*out); });
    }

    void tell_tracer(int rank, Message message) {
        const auto index = static_cast<std::size_t>(rank);
        if (const auto* order = std::get_if<CloudOrder>(&message)) {
            if (index >= options_.owners) return;
            for (std::size_t i = 0; i < options_.owners; ++i) {
                if (i != index)
                    post(rank, schedule_.uniform(1), {static_cast<int>(i), Role::worker},
                         CloudPoints{order->rules.frame, {}});
            }
        } else if (const auto* stage = std::get_if<CloudStage>(&message)) {
            if (stage->kind == CloudStage::Kind::points) return find_uncached(rank, stage->frame);
            ++pixel_stages;
            post(rank, schedule_.uniform(1), {rank, Role::worker}, part_of(stage->frame));
        } else if (auto* uncached = std::get_if<GiveUncachedPixels>(&message)) {
            if (uncached->places.empty())
                ++ends;
            else
                ranks_[index].uncached.push_back(std::move(*uncached));
            trace(rank);
        }
    }

    void find_uncached(int rank, std::uint64_t frame) {
        const auto index = static_cast<std::size_t>(rank);
        const double answered = schedule_.uniform(1);
        const SubImages parts({0, 0, kWidth, kHeight}, options_.owners);
        for (const std::size_t i : owners_beside(parts, index, kWidth, kHeight))
            post(rank, answered, {static_cast<int>(i), Role::worker}, CloudUsed{frame, {}});
        UncachedPixels uncached{frame, 0, {}};
        const int count = static_cast<int>(schedule_.uniform(options_.most_uncached));
        uncached.noise_pairs = static_cast<std::uint32_t>(
            schedule_.uniform(std::min(count, options_.most_noise_pairs)));
        uncached.places.resize(static_cast<std::size_t>(count));
        expected += uncached.places.size();
        post(rank, answered, {rank, Role::worker}, std::move(uncached));
    }

    void trace(int number) {
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        while (rank.free_slots > 0 && !rank.uncached.empty()) {
            --rank.free_slots;
            const GiveUncachedPixels uncached = std::move(rank.uncached.front());
            rank.uncached.pop_front();
            const auto count = static_cast<std::uint32_t>(uncached.places.size());
            for (std::size_t i = 0; i < count; ++i)
                ++traced[{uncached.owner, uncached.frame, uncached.first + i}];
            schedule_.after(schedule_.uniform(1), [this, number, uncached, count] {
                Outbox out;
                out.push_back({{number, Role::tracer},
                               {static_cast<int>(uncached.owner), Role::worker},
                               TracedPixelResults{uncached.frame, uncached.first, count, {}}});
                out.push_back({{number, Role::tracer}, {0, Role::master}, AskUncachedPixels{1}});
                send(out);
                ++ranks_[static_cast<std::size_t>(number)].free_slots;
                trace(number);
            });
        }
    }

    WalkOptions options_;
    RandomSchedule schedule_;
    CloudMasterRole master_;
    std::vector<Rank> ranks_;
};

}  // namespace

TEST_CASE(
    "a walk over ranks: each uncached pixel is traced once, and each frame ends, in 1000 "
    "schedules") {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        CAPTURE(seed);
        WalkOptions options;
        options.workers = 1 + static_cast<int>(seed % 7);
        options.owners = 1 + seed % static_cast<std::uint64_t>(options.workers);
        options.slots = 1 + static_cast<int>(seed % 3);
        options.most_uncached = seed % 5 == 0 ? 3 : 300;
        const Walk walk(options, seed);
        REQUIRE(walk.finished == options.frames);
        CHECK(walk.traced.size() == walk.expected);
        const bool once = std::all_of(walk.traced.begin(), walk.traced.end(),
                                      [](const auto& entry) { return entry.second == 1; });
        CHECK(once);
        CHECK(walk.ends == options.frames * static_cast<std::uint64_t>(options.workers));
        CHECK(walk.pixel_stages == options.frames * options.owners);
    }
}

TEST_CASE("a walk over ranks: what nobody asked for is refused") {
    const auto worker = [](Outbox& out) {
        CloudWorkerRole role({{1, Role::worker}, {0, Role::master}, 0, 2, 1, 1});
        role.begin(out);
        CloudOrder order;
        order.width = kWidth;
        order.height = kHeight;
        role.handle({{0, Role::master}, {1, Role::worker}, order}, out);
        return role;
    };
    const auto from = [](Message message) {
        return Envelope{{2, Role::tracer}, {1, Role::worker}, std::move(message)};
    };
    Outbox out;
    CloudWorkerRole role = worker(out);
    CHECK_THROWS_AS(role.handle(from(TracedPixelResults{0, 0, 1, {}}), out), InputError);
    role = worker(out);
    role.handle(from(CloudPoints{0, {}}), out);
    CHECK_THROWS_AS(role.handle(from(CloudPoints{0, {}}), out), InputError);
    role = worker(out);
    role.handle({{1, Role::tracer}, {1, Role::worker}, UncachedPixels{0, 0, {{1, 1}, {2, 1}}}},
                out);
    CHECK_THROWS_AS(role.handle(from(TracedPixelResults{0, 1, 2, {}}), out), InputError);
    CHECK_THROWS_AS(role.handle(from(TracedPixelResults{0, 0, 1, {{}, {}}}), out), InputError);
    role.handle(from(TracedPixelResults{0, 1, 1, {}}), out);
    CHECK_THROWS_AS(role.handle(from(TracedPixelResults{0, 1, 1, {}}), out), InputError);
    CloudMasterRole master({0, Role::master}, {1, 2}, 2, 2);
    CHECK_THROWS_AS(
        master.handle({{1, Role::worker}, {0, Role::master}, UncachedPixels{0, 0, {}}}, out),
        InputError);
    CHECK_THROWS_AS(master.handle({{1, Role::worker}, {0, Role::master}, CloudPart{}}, out),
                    InputError);
}

TEST_CASE("a walk over ranks: parts that touch, also at a corner, are beside each other") {
    const SubImages parts({0, 0, 40, 40}, 4);  // two by two
    for (std::size_t i = 0; i < 4; ++i) CHECK(owners_beside(parts, i, 40, 40).size() == 3);
    const SubImages few({0, 0, 1, 2}, 4);  // two own nothing
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < 4; ++i) pairs += owners_beside(few, i, 1, 2).size();
    CHECK(pairs == 2);
}
