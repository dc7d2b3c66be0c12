#include "core/cloud/moving_size.h"

#include <doctest/doctest.h>

#include <utility>

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

/// Of a machine that had time for all of it.
MovingSize grown() {
    MovingSize size;
    record(size, 20, 0, 0.1);
    return size;
}

}  // namespace

TEST_CASE("moving size: the first frames are small, those in time soon as large as asked for") {
    MovingSize size;
    CHECK(size.share() == 0.5);
    record(size, 8, 0, 0.2);
    CHECK(size.share() == 1);
    record(size, 100, 0, 0.9);
    CHECK(size.share() == 1);
    record(size, 1, 0.2, 1);  // a busy machine, once
    record(size, 100, 0.01, 1);
    CHECK(size.of(1280) == 1280);
}

TEST_CASE("moving size: guessed pixels make frames smaller, the more of them the sooner") {
    MovingSize little = grown(), much = grown();
    record(little, 1, 0.05, 1);
    CHECK(little.share() == 1);
    record(little, 1, 0.05, 1);
    CHECK(little.of(1000) == 841);
    record(much, 1, 0.5, 1);
    CHECK(much.of(1000) == 500);
    record(much, 100, 1, 1);
    CHECK(much.of(1000) == 354);
    CHECK(much.of(1) == 1);
}

namespace {

/// Frames of so many pixels at full size, of which a share is guessed.
void record_of(MovingSize& size, int frames, int pixels, double guessed, double time = 1) {
    for (int i = 0; i < frames; ++i) {
        CloudReport report;
        report.pixels = static_cast<std::size_t>(size.share() * size.share() * pixels);
        report.filled = static_cast<std::size_t>(guessed * static_cast<double>(report.pixels));
        report.check_seconds = time;
        size.record(report, 1);
    }
}

constexpr int kHd = 1280 * 720, kFullHd = 1920 * 1080;

}  // namespace

TEST_CASE("moving size: frames of large pictures may be a quarter as wide, of others a third") {
    for (const auto& [pixels, least] : {std::pair(kHd, 354), std::pair(kFullHd, 250)}) {
        MovingSize size;
        record_of(size, 100, pixels, 0.05);
        CHECK(size.of(1000) == least);
    }
}

TEST_CASE("moving size: where much would be guessed all the same, frames are rather blurred") {
    for (const auto& [pixels, least] :
         {std::pair(640 * 480, 354), std::pair(kHd, 177), std::pair(kFullHd, 149)}) {
        MovingSize size;
        record_of(size, 100, pixels, 1);
        CHECK(size.of(1000) == least);
        // So they stay while a little is guessed, and grow where nothing is.
        record_of(size, 100, pixels, 0.03, 0.3);
        CHECK(size.of(1000) == least);
        record_of(size, 1000, pixels, 0, 0.1);
        CHECK(size.of(1000) == 1000);
    }
}

TEST_CASE("moving size: frames that take longer than there is time for get smaller") {
    MovingSize size = grown();
    record(size, 1, 0, 1.5);
    CHECK(size.share() == 1);
    record(size, 1, 0, 1.5);
    CHECK(size.of(1000) == 841);
    CloudReport traced = drawn(0, 0.7);
    traced.trace_seconds = 0.3;  // what was left
    for (int i = 0; i < 5; ++i) size.record(traced, 1);
    CHECK(size.of(1000) == 841);
    traced.trace_seconds = 0.6;
    for (int i = 0; i < 2; ++i) size.record(traced, 1);
    CHECK(size.of(1000) == 707);
}

TEST_CASE("moving size: who is patient gets fewer frames before they get smaller") {
    MovingSize size;
    size.set_patient(true);
    CHECK(size.share() == 0.5);
    CHECK(size.periods(1280, 720) == 2);
    record(size, 30, 0, 0.3);
    CHECK(size.share() == 1);
    CHECK(size.periods(1280, 720) == 1);
    record(size, 2, 0.05, 1);
    CHECK(size.share() == 1);
    CHECK(size.periods(1280, 720) == 2);
    CHECK(size.periods(640, 480) == 1);
    CHECK(size.periods(1920, 1080) == 2.5);
    CHECK(size.periods(3840, 2160) == 2.5);
    record(size, 3, 0.05, 1);
    CHECK(size.of(1000) == 841);
    CHECK(size.periods(1280, 720) == 2);
    record(size, 100, 0, 0.3);
    size.set_patient(false);
    CHECK(size.share() == 1);
    CHECK(size.periods(1280, 720) == 1);
    record(size, 2, 0.05, 1);
    CHECK(size.of(1000) == 841);
}

TEST_CASE("moving size: no more pixels than a link carries, and never fewer than the least") {
    MovingSize size;
    size.set_patient(true);
    record(size, 30, 0, 0.1);
    size.limit(1280, 720, 1e9);
    CHECK(size.share() == 1);
    size.limit(1280, 720, 1280 * 720 / 4.0);  // a quarter of the picture
    CHECK(size.share() == 0.5);
    record(size, 100, 0, 0.1);
    CHECK(size.share() == 0.5);
    size.limit(1280, 720, 1);
    CHECK(size.of(1000) == 354);
    size.limit(1280, 720, 1e9);
    record(size, 300, 0, 0.1);
    CHECK(size.share() == 1);
}

TEST_CASE("moving size: pixels inferred from their own surface count little") {
    MovingSize size = grown();
    CloudReport report = drawn(0.25, 1);
    report.inferred = report.filled;
    for (int i = 0; i < 10; ++i) size.record(report, 1);
    CHECK(size.share() == 1);
    report = drawn(0.4, 1);
    report.inferred = report.filled;
    for (int i = 0; i < 2; ++i) size.record(report, 1);
    CHECK(size.share() < 1);
}

TEST_CASE(
    "moving size: a larger size is tried where there is time for it, and later where "
    "that failed") {
    MovingSize size = grown();
    const auto frames_until = [&](double share, double guessed, double time) {
        int frames = 0;
        for (; size.share() != share && frames < 10000; ++frames) record(size, 1, guessed, time);
        return frames;
    };
    record(size, 100, 0, 0.9);  // the first frames, which are larger soon, are forgotten
    record(size, 2, 0.05, 1);
    record(size, 100, 0, 0.7);
    CHECK(size.share() < 1);  // more pixels would not fit
    const int first = frames_until(1, 0, 0.3);
    CHECK(first < 20);
    (void)frames_until(0.8409, 0.1, 1);
    const int second = frames_until(1, 0, 0.3);
    CHECK(second > 1.5 * first);
    record(size, 100, 0, 0.9);  // it held: what failed before is forgotten
    (void)frames_until(0.8409, 0.1, 1);
    CHECK(frames_until(1, 0, 0.3) < 1.5 * first);
}
