#include "parallel/walk/moving_size.h"

#include <doctest/doctest.h>

using namespace lightwalk;

namespace {

/// A frame that is guessed in part, and took a share of the time that there was.
CloudReport drawn(double guessed, double time) {
    CloudReport report;
    report.pixels = 1000;
    report.filled = static_cast<std::size_t>(1000 * guessed);
    report.check_seconds = time;
    return report;
}

void record(MovingSize& size, int frames, double guessed, double time) {
    for (int i = 0; i < frames; ++i) size.record(drawn(guessed, time), 1);
}

}  // namespace

TEST_CASE("moving size: frames that are in time are as large as they were asked for") {
    MovingSize size;
    record(size, 100, 0, 0.9);
    CHECK(size.share() == 1);
    record(size, 1, 0.9, 1);  // a busy machine, once
    record(size, 100, 0.01, 1);
    CHECK(size.of(1280) == 1280);
}

TEST_CASE("moving size: guessed pixels make frames smaller, the more of them the sooner") {
    MovingSize little, much;
    record(little, 2, 0.05, 1);
    record(much, 2, 0.5, 1);
    CHECK(little.of(1000) == 707);
    CHECK(much.of(1000) == 500);
    record(much, 100, 1, 1);
    CHECK(much.of(1000) == 354);
    CHECK(much.of(1) == 1);
}

TEST_CASE("moving size: pixels inferred from their own surface count little") {
    MovingSize size;
    CloudReport report = drawn(0.1, 1);
    report.inferred = report.filled;
    for (int i = 0; i < 10; ++i) size.record(report, 1);
    CHECK(size.share() == 1);
    report = drawn(0.3, 1);
    report.inferred = report.filled;
    for (int i = 0; i < 2; ++i) size.record(report, 1);
    CHECK(size.share() < 1);
}

TEST_CASE(
    "moving size: a larger size is tried where there is time for twice the pixels, and later where "
    "that failed") {
    MovingSize size;
    const auto frames_until = [&](double share, double guessed, double time) {
        int frames = 0;
        for (; size.share() != share && frames < 10000; ++frames) record(size, 1, guessed, time);
        return frames;
    };
    record(size, 2, 0.05, 1);
    record(size, 100, 0, 0.6);
    CHECK(size.share() < 1);  // twice the pixels would not fit
    const int first = frames_until(1, 0, 0.3);
    CHECK(first < 20);
    (void)frames_until(0.7071, 0.1, 1);
    const int second = frames_until(1, 0, 0.3);
    CHECK(second > 1.5 * first);
    record(size, 100, 0, 0.9);  // it held: what failed before is forgotten
    (void)frames_until(0.7071, 0.1, 1);
    CHECK(frames_until(1, 0, 0.3) < 1.5 * first);
}
