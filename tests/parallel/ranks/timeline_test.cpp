#include "parallel/ranks/timeline.h"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace lightwalk;

TEST_CASE("a timeline adds up by thread and activity, and keeps spans when asked to") {
    using std::chrono::milliseconds;
    for (const bool keep : {false, true}) {
        Timeline timeline(3, keep);
        const Timeline::Clock::time_point zero = Timeline::Clock::now();
        timeline.add(0, Activity::trace, zero, zero + milliseconds(250));
        timeline.add(0, Activity::wait, zero + milliseconds(250), zero + milliseconds(300));
        timeline.add(0, Activity::trace, zero + milliseconds(300), zero + milliseconds(550));
        timeline.add(timeline.message_row(), Activity::handle, zero, zero + milliseconds(1));
        const Timeline::Row row = timeline.row(0);
        constexpr double kRounding = 1e-12;
        CHECK(row.seconds[static_cast<std::size_t>(Activity::trace)] ==
              doctest::Approx(.5).epsilon(kRounding));
        CHECK(row.seconds[static_cast<std::size_t>(Activity::wait)] ==
              doctest::Approx(.05).epsilon(kRounding));
        CHECK(row.spans.size() == (keep ? 3 : 0));
        if (keep) {
            CHECK(row.spans[1].activity == Activity::wait);
            CHECK(row.spans[1].begin == doctest::Approx(timeline.since(zero) + .25));
            CHECK(row.spans[1].end == doctest::Approx(timeline.since(zero) + .3));
            const std::vector<Timeline::Row> later = timeline.rows_since(timeline.since(zero) + .1);
            REQUIRE(later.size() == 3);
            CHECK(later[0].spans[1].begin == doctest::Approx(.15));
            CHECK(later[0].spans[1].end == doctest::Approx(.2));
        }
        CHECK(timeline.row(1).spans.empty());
        CHECK(timeline.row(2).seconds[static_cast<std::size_t>(Activity::handle)] > 0);
    }
}

TEST_CASE("what is timed is at least as long as it took") {
    Timeline timeline(1, true);
    {
        const TimedActivity timed(timeline, 0, Activity::compress);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    REQUIRE(timeline.row(0).spans.size() == 1);
    CHECK(timeline.row(0).seconds[static_cast<std::size_t>(Activity::compress)] >= .002);
}
