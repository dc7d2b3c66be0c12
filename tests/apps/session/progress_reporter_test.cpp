#include "apps/session/progress_reporter.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

WorkPhase phase_of(double pixels) {
    WorkPhase phase;
    phase.pixels = pixels;
    return phase;
}

}  // namespace

TEST_CASE("progress: it begins, grows, counts the rays of all phases, and ends") {
    using Stage = RenderProgress::Stage;
    std::vector<RenderProgress> told;
    ProgressReporter reporter({[&](const RenderProgress& one) { told.push_back(one); }, 0},
                              {phase_of(100), phase_of(1000)});
    reporter.update(0, {0.5, 10, 0});
    reporter.update(0, {1, 30, 0});
    reporter.update(1, {0.25, 100, 0});
    reporter.update(1, {0.75, 300, 0});
    reporter.finish(true, 400);
    REQUIRE(told.size() == 6);
    CHECK(told.front().stage == Stage::begun);
    CHECK(told.front().rays == 0);
    for (std::size_t i = 1; i < told.size(); ++i) {
        CHECK(told[i].done >= told[i - 1].done);
        CHECK(told[i].rays >= told[i - 1].rays);
        CHECK(told[i].seconds >= told[i - 1].seconds);
    }
    CHECK(told[4].stage == Stage::running);
    CHECK(told[4].rays == 330);
    CHECK(told.back().stage == Stage::finished);
    CHECK(told.back().done == 1);
    CHECK(told.back().rays == 400);
}

TEST_CASE("progress: between two reports passes what was asked for, and a stop is told as one") {
    std::vector<RenderProgress> told;
    ProgressReporter reporter({[&](const RenderProgress& one) { told.push_back(one); }, 1000},
                              {phase_of(100)});
    for (int i = 0; i < 100; ++i) reporter.update(0, {0.01 * i, 1, 0});
    CHECK(told.size() == 1);
    reporter.finish(false, 1);
    REQUIRE(told.size() == 2);
    CHECK(told.back().stage == RenderProgress::Stage::cancelled);
    CHECK(told.back().done < 1);
    ProgressReporter nobody({}, {phase_of(100)});
    nobody.update(0, {0.5, 1, 0});
    nobody.finish(true, 1);
}
