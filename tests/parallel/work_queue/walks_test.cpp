// The frames of a walk through the roles of all ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/ranks/tracer_inbox.h"
#include "tests/one_thread.h"
#include "tests/parallel/work_queue/rank_network.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kWidth = 40, kHeight = 30;

struct WalkOptions {
    int workers = 3, slots = 1, ahead = 1;
    int owners = 3;
    std::uint64_t frames = 3;
    int most_uncached = 200, most_noise_pairs = 5;
};

RankSettings settings_of(const WalkOptions& options) {
    RankSettings settings;
    settings.slots = options.slots;
    settings.ahead = options.ahead;
    settings.projectors = options.owners;
    return settings;
}

/// All that ranks do takes random times.
class Walk final : public RankNetwork {
  public:
    Walk(const WalkOptions& options, std::uint64_t seed)
        : RankNetwork(make_topology(Variant::hybrid, options.workers, false, 1),
                      settings_of(options), 1, seed),
          options_(options),
          threads_(options.workers, options.slots, schedule()),
          ranks_(static_cast<std::size_t>(options.workers)) {
        begin();
        order();
        run();
    }

    /// Owner, frame, number of the pixel: how often it was traced.
    std::map<std::tuple<std::size_t, std::uint64_t, std::size_t>, int> traced;
    std::size_t expected = 0;  ///< pixels that should have been
    std::uint64_t finished = 0;
    std::size_t ends = 0;   ///< of frames, told to tracers
    std::size_t whole = 0;  ///< parts all of whose pixels came back

  private:
    struct Rank {
        // Of the frame at hand; mail of the next one may come before it.
        FrameNumber frame = 0;
        bool projected = false, answered = false, told = false, gathered = false;
        std::size_t pixels = 0;
        std::map<FrameNumber, std::size_t> points, used, arrived;
    };
    [[nodiscard]] bool owns(int rank) const { return rank < options_.owners; }
    [[nodiscard]] std::vector<std::size_t> beside(int rank) const {
        const SubImages parts({0, 0, kWidth, kHeight}, static_cast<std::size_t>(options_.owners));
        return owners_beside(parts, static_cast<std::size_t>(rank), kWidth, kHeight);
    }

    void order() {
        FrameOrder order;
        order.number = finished + 1;
        order.width = kWidth;
        order.height = kHeight;
        step(0, [&](RankRoles& roles, Outbox& out) { roles.queue().start(order, out); });
    }

    void take(ProgramNews news) override {
        CHECK(std::get<FinishedFrame>(news).parts.size() ==
              static_cast<std::size_t>(options_.owners));
        if (++finished < options_.frames) schedule().after(0, [this] { order(); });
    }

    void take(int number, TracerNews news) override {
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        std::visit(
            Overloaded{
                [](PictureJob&) { FAIL("nobody asked for a picture"); },
                [](ChangeOrder&) { FAIL("nobody asked for another scene"); },
                [&](FrameOrder& order) { project(number, order.number); },
                [&](WorkGrant& grant) {
                    for (Work& piece : grant.pieces)
                        threads_.waiting(number).push_back(std::get<PixelRun>(std::move(piece)));
                    ends += grant.frame_over ? 1 : 0;
                    threads_.trace(number, 1, [this, number](const PixelRun& run, double) {
                        finish(number, run);
                    });
                },
                [&](PointExchange& exchange) {
                    const bool points = std::holds_alternative<SharedPoints>(exchange.points);
                    ++(points ? rank.points : rank.used)[exchange.frame];
                },
                [&](TracedRun& run) { rank.arrived[run.frame] += run.count; }},
            news);
        look_on(number);
    }

    void project(int number, FrameNumber frame) {
        if (!owns(number)) return;
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        rank.frame = frame;
        rank.projected = true;
        rank.answered = rank.told = rank.gathered = false;
        for (int i = 0; i < options_.owners; ++i)
            if (i != number) later(number, i, PointExchange{frame, SharedPoints{}});
    }

    /// A rank's frame goes on as soon as all that it waits for is there.
    void look_on(int number) {
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        if (!rank.projected || rank.gathered) return;
        const auto others = static_cast<std::size_t>(options_.owners - 1);
        if (!rank.answered) {
            if (rank.points[rank.frame] < others) return;
            rank.answered = true;
            find_uncached(number);
        }
        if (!rank.told || rank.arrived[rank.frame] < rank.pixels ||
            rank.used[rank.frame] < beside(number).size())
            return;
        CHECK(rank.arrived[rank.frame] == rank.pixels);
        CHECK(rank.points[rank.frame] == others);
        rank.gathered = true;
        ++whole;
        FramePart part;
        part.frame = rank.frame;
        later(number, 0, FinishedPart{std::move(part)});
    }

    /// What a rank finds it tells after a while, at once.
    void find_uncached(int number) {
        Rank& rank = ranks_[static_cast<std::size_t>(number)];
        UncachedPixels pixels{rank.frame, 0, {}};
        const int count = static_cast<int>(schedule().uniform(options_.most_uncached));
        pixels.noise_pairs = static_cast<std::uint32_t>(
            schedule().uniform(std::min(count, options_.most_noise_pairs)));
        pixels.places.resize(static_cast<std::size_t>(count));
        rank.pixels = pixels.places.size();
        expected += rank.pixels;
        schedule().after(schedule().uniform(1), [this, number, pixels] {
            for (const std::size_t i : beside(number))
                post(number, static_cast<int>(i), PointExchange{pixels.frame, UsedPixels{}});
            post(number, 0, pixels);
            ranks_[static_cast<std::size_t>(number)].told = true;
            look_on(number);
        });
    }

    void later(int from, int to, Message message) {
        schedule().after(schedule().uniform(1),
                         [this, from, to, message] { post(from, to, message); });
    }

    void finish(int number, const PixelRun& run) {
        const auto count = static_cast<std::uint32_t>(run.places.size());
        for (std::size_t i = 0; i < count; ++i) ++traced[{run.owner, run.frame, run.first + i}];
        step(number, [&](RankRoles& roles, Outbox& out) {
            roles.worker().finish({FinishedWork::Payload::pixels, 0, count, 0},
                                  TracedRun{run.frame, run.owner, run.first, count, {}}, out);
        });
    }

    WalkOptions options_;
    TracingThreads<PixelRun> threads_;
    std::vector<Rank> ranks_;
};

}  // namespace

TEST_CASE("a walk over ranks: each pixel is traced once, and each frame ends, in 1000 schedules" *
          one_thread) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        CAPTURE(seed);
        WalkOptions options;
        options.workers = 1 + static_cast<int>(seed % 7);
        options.owners = 1 + static_cast<int>(seed % static_cast<std::uint64_t>(options.workers));
        options.slots = 1 + static_cast<int>(seed % 3);
        options.most_uncached = seed % 5 == 0 ? 3 : 300;
        const Walk walk(options, seed);
        REQUIRE(walk.finished == options.frames);
        CHECK(walk.traced.size() == walk.expected);
        const bool once = std::all_of(walk.traced.begin(), walk.traced.end(),
                                      [](const auto& entry) { return entry.second == 1; });
        CHECK(once);
        CHECK(walk.ends == options.frames * static_cast<std::uint64_t>(options.workers));
        CHECK(walk.whole == options.frames * static_cast<std::uint64_t>(options.owners));
    }
}

TEST_CASE("a walk over ranks: what nobody asked for is refused") {
    Outbox out;
    PixelSupply supply({1, 2}, 2);
    CHECK_THROWS_AS(supply.add(1, UncachedPixels{0, 0, {}}), InputError);  // no frame
    CHECK_THROWS_AS(supply.gather(1, FramePart{}, out), InputError);
    supply.start(3);
    CHECK_THROWS_AS(supply.start(4), InputError);
    CHECK_THROWS_AS(supply.add(1, UncachedPixels{4, 0, {}}), InputError);  // another frame
    CHECK_THROWS_AS(supply.add(3, UncachedPixels{3, 0, {}}), InputError);  // no owner
    CHECK_THROWS_AS(supply.add(1, UncachedPixels{3, 2, {{1, 1}}}), InputError);
    supply.add(1, UncachedPixels{3, 0, {}});
    CHECK_THROWS_AS(supply.add(1, UncachedPixels{3, 0, {}}), InputError);  // twice
    FramePart part;
    part.frame = 3;
    CHECK_THROWS_AS(supply.gather(2, part, out), InputError);  // its pixels are not known
    supply.gather(1, part, out);
    CHECK_THROWS_AS(supply.gather(1, part, out), InputError);
    CHECK_FALSE(supply.over());
    supply.add(2, UncachedPixels{3, 0, {}});
    CHECK(supply.over() == 3);
    CHECK_FALSE(supply.over());
}

TEST_CASE("a walk over ranks: once time is over what is left of a frame is handed out as a whole") {
    constexpr std::size_t kPixels = 20'000;
    const auto late = [](FrameNumber frame) {
        return FinishedWork{FinishedWork::Payload::pixels, 0, 1, 0, frame};
    };
    PixelSupply supply({0, 1}, 2);
    const auto begin = [&](FrameNumber frame) {
        supply.start(frame);
        supply.add(0, UncachedPixels{frame, 10, std::vector<PixelPlace>(kPixels)});
        supply.add(1, UncachedPixels{frame, 0, std::vector<PixelPlace>(kPixels)});
    };
    const auto runs = [&] {
        std::size_t count = 0, pixels = 0;
        for (; const std::optional<PixelRun> run = supply.next(); ++count)
            pixels += run->places.size();
        return std::pair(count, pixels);
    };
    begin(1);
    const std::size_t first = supply.next().value().places.size();
    CHECK(first < kPixels / 8);
    supply.note({FinishedWork::Payload::pixels, 0, 1, 0});
    CHECK(supply.next().value().places.size() <= first);
    supply.note(late(1));
    CHECK(runs().first == 3);  // one of the noise pairs, as they are traced by other rays
    Outbox out;
    FramePart part;
    part.frame = 1;
    for (const int owner : {0, 1}) supply.gather(owner, part, out);
    begin(2);
    supply.note(late(1));  // of the frame before
    const auto [count, pixels] = runs();
    CHECK(count > 20);
    CHECK(pixels == 2 * kPixels);
}

TEST_CASE("mail of a frame is kept until all of it is there, whatever comes first") {
    TracerInbox inbox;
    const StopFlag never;
    inbox.push(TracedRun{2, 0, 0, 5, {}});  // of the next frame
    inbox.push(PointExchange{2, SharedPoints{}});
    inbox.push(PointExchange{1, UsedPixels{{{1, 1}}, {}}});
    inbox.push(TracedRun{1, 0, 0, 3, {}});
    inbox.push(TracedRun{1, 0, 3, 1, {}});
    const auto first = inbox.mail(1, 4, 1, never);
    REQUIRE(first);
    CHECK(first->runs.size() == 2);
    CHECK(first->used.size() == 1);
    CHECK(inbox.points(2, 1, never)->size() == 1);
    CHECK(inbox.mail(2, 5, 0, never)->runs.size() == 1);
    SUBCASE("runs of a frame end with it") {
        inbox.push(WorkGrant{{PixelRun{3, 0, 0, false, true, {{1, 2}}}}, std::nullopt});
        inbox.push(WorkGrant{{}, FrameNumber{3}});
        inbox.push(WorkGrant{{PixelRun{4, 0, 0, false, true, {{1, 2}}}}, std::nullopt});
        CHECK(inbox.next_run(3, never));
        CHECK_FALSE(inbox.next_run(3, never));
        CHECK(inbox.next_run(4, never));
    }
    SUBCASE("who waits is told that no more comes") {
        inbox.close();
        CHECK_FALSE(inbox.next_order(never));
        CHECK_FALSE(inbox.mail(3, 1, 0, never));
    }
    SUBCASE("a block of a picture that nobody began is refused") {
        CHECK_THROWS_AS(inbox.push(WorkGrant{{JobBlock{7, {0, 0, 1, 1}}}, std::nullopt}),
                        InputError);
    }
}

TEST_CASE("a walk over ranks: parts that touch, also at a corner, are beside each other") {
    const SubImages parts({0, 0, 40, 40}, 4);  // two by two
    for (std::size_t i = 0; i < 4; ++i) CHECK(owners_beside(parts, i, 40, 40).size() == 3);
    const SubImages few({0, 0, 1, 2}, 4);  // two own nothing
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < 4; ++i) pairs += owners_beside(few, i, 1, 2).size();
    CHECK(pairs == 2);
}
