#include "io/net/frame_flow.h"

#include <doctest/doctest.h>

#include <map>
#include <random>

using namespace lightwalk;
using std::chrono::milliseconds;

namespace {

using Numbers = std::vector<std::size_t>;
using Contents = std::vector<std::uint64_t>;

FrameFlow::Time at(int ms) {
    return FrameFlow::Time{} + milliseconds(ms);
}

/// A link of so many bytes a millisecond with a delay each way; frames are drawn at once. The
/// server has a new frame every millisecond.
struct Link {
    double bytes_per_ms = 250;  // 2 Mbit/s
    int delay = 50;             // [ms]
    std::size_t frame_bytes = 25'000;

    struct Outcome {
        int frames = 0;
        int worst_wait = 0;  ///< of a frame before it is on the wire [ms]
        double speed = 0;    ///< as the flow has it [bytes/s]
    };
    [[nodiscard]] Outcome run(int duration) const {
        FrameFlow flow;
        Outcome outcome;
        std::map<int, std::uint32_t> acks;  // by their time
        double wire_free = 0;
        std::uint32_t frame = 0;
        for (int now = 1; now <= duration; ++now) {
            if (const auto ack = acks.find(now); ack != acks.end()) {
                CHECK(flow.acked(ack->second, at(now)));
                ++outcome.frames;
            }
            CHECK(flow.under_way() <= 2);
            if (!flow.may_send(at(now))) continue;
            const double start = std::max<double>(now, wire_free);
            wire_free = start + static_cast<double>(frame_bytes) / bytes_per_ms;
            outcome.worst_wait = std::max(outcome.worst_wait, static_cast<int>(start) - now);
            acks[static_cast<int>(wire_free) + 2 * delay] = ++frame;
            flow.sent(frame, 1, Contents{frame}, frame_bytes, at(now));
        }
        outcome.speed = flow.bytes_per_second();
        return outcome;
    }
};

}  // namespace

TEST_CASE("frame flow: the first frame goes at once, the second follows its acknowledgement") {
    FrameFlow flow;
    CHECK(flow.may_send(at(0)));
    flow.sent(1, 1, Contents{1}, 1000, at(0));
    CHECK_FALSE(flow.may_send(at(100'000)));  // nothing is known of this client yet
    CHECK(flow.acked(1, at(100)));
    CHECK(flow.round_trip() == FrameFlow::Seconds(0.1));
    CHECK(flow.may_send(at(100)));
}

TEST_CASE("frame flow: a second frame follows when the first leaves the wire, never a third") {
    FrameFlow flow;
    flow.sent(1, 1, Contents{1}, 1000, at(0));
    CHECK(flow.acked(1, at(100)));  // 10 bytes a millisecond at least
    flow.sent(2, 1, Contents{2}, 2000, at(200));
    CHECK(flow.next_chance() == at(350));  // three quarters of 200 ms
    CHECK_FALSE(flow.may_send(at(349)));
    CHECK(flow.may_send(at(350)));
    flow.sent(3, 1, Contents{3}, 1000, at(350));
    CHECK_FALSE(flow.may_send(at(100'000)));
    CHECK(flow.next_chance() == FrameFlow::Time::max());
    // Earlier than thought: the wire is the third's at once, and faster.
    CHECK(flow.acked(2, at(360)));
    CHECK(flow.next_chance() < at(360 + 75));
    CHECK(flow.next_chance() > at(360));
}

TEST_CASE("frame flow: an acknowledgement covers the frames before it, wrong ones change nothing") {
    FrameFlow flow;
    CHECK_FALSE(flow.acked(0, at(0)));
    flow.sent(1, 1, Contents{1}, 1000, at(0));
    CHECK_FALSE(flow.acked(2, at(1)));
    CHECK(flow.acked(1, at(2)));
    CHECK_FALSE(flow.acked(1, at(3)));
    flow.sent(2, 1, Contents{2}, 1000, at(4));
    flow.sent(3, 1, Contents{3}, 1000, at(8));
    CHECK(flow.acked(3, at(10)));
    CHECK(flow.under_way() == 0);
    CHECK_FALSE(flow.acked(2, at(11)));
}

TEST_CASE("frame flow: only pieces that changed since the client's last frame are missing") {
    FrameFlow flow;
    CHECK(flow.missing(1, Contents{5, 5, 5}) == Numbers{0, 1, 2});
    flow.sent(1, 1, Contents{5, 5, 5}, 1, at(0));
    CHECK(flow.missing(1, Contents{5, 5, 5}).empty());
    CHECK(flow.missing(1, Contents{5, 6, 5}) == Numbers{1});
    // Frames that this client was not sent changed one piece after the other.
    CHECK(flow.missing(1, Contents{7, 6, 5}) == Numbers{0, 1});
    flow.sent(2, 1, Contents{7, 6, 5}, 1, at(1));
    CHECK(flow.missing(1, Contents{7, 6, 8}) == Numbers{2});
    // Cut otherwise, everything is new, whatever its numbers.
    CHECK(flow.missing(2, Contents{7, 6, 5}) == Numbers{0, 1, 2});
    CHECK(flow.missing(1, Contents{7, 6}) == Numbers{0, 1});
    CHECK(flow.missing(2, {}).empty());
}

TEST_CASE("frame flow: whatever is dropped, a client that takes what is missing has the newest") {
    std::mt19937 random(11);
    for (int run = 0; run < 50; ++run) {
        FrameFlow flow;
        Contents server(6, 0), client;
        std::uint64_t layout = 1, next = 1;
        for (std::uint32_t frame = 1; frame < 60; ++frame) {
            for (std::uint64_t& piece : server) {
                if (random() % 3 == 0) piece = next++;
            }
            if (random() % 20 == 0) {
                server.resize(1 + random() % 8, next++);
                ++layout;
            }
            if (random() % 2 == 0) continue;  // not sent
            const Numbers missing = flow.missing(layout, server);
            client.resize(server.size());
            for (const std::size_t i : missing) client[i] = server[i];
            flow.sent(frame, layout, server, 1, at(static_cast<int>(frame)));
            CHECK(client == server);
            if (random() % 2 == 0) CHECK(flow.acked(frame, at(static_cast<int>(frame) + 1)));
        }
    }
}

TEST_CASE("frame flow: a slow link is kept busy, and next to nothing waits before it") {
    // 100 ms a frame on the wire, 100 ms there and back.
    const Link::Outcome slow = Link{}.run(20'000);
    CHECK(slow.frames >= 180);  // of 200; one at a time would be 100
    CHECK(slow.worst_wait <= 30);
    CHECK(slow.speed == doctest::Approx(250'000).epsilon(0.05));
    // Frames too large for the link: 600 ms each.
    const Link::Outcome large = Link{.frame_bytes = 150'000}.run(20'000);
    CHECK(large.frames >= 31);  // of 33
    CHECK(large.worst_wait <= 180);
    CHECK(large.speed == doctest::Approx(250'000).epsilon(0.05));
}

TEST_CASE("frame flow: a fast link is never what is waited for") {
    const Link::Outcome local = Link{.bytes_per_ms = 1e6, .delay = 5}.run(2000);
    CHECK(local.frames >= 350);  // of 400, two in each round trip of 10 ms
    CHECK(local.worst_wait == 0);
}
