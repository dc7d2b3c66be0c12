#include "apps/progress_printer.h"

#include <doctest/doctest.h>

#include <array>
#include <string>

using namespace lightwalk;

namespace {

/// A second after the work began.
RenderProgress progress_of(double done, std::uint64_t rays, std::optional<double> seconds_left) {
    return {RenderProgress::Stage::running, done, rays, 1, seconds_left};
}

}  // namespace

TEST_CASE("a progress line never fills the terminal's last column, whatever its width") {
    for (const std::uint64_t rate :
         {std::uint64_t{0}, std::uint64_t{999'000}, std::uint64_t{123'450'000}}) {
        for (const double left : {0.0, 59.0, 3.6e6}) {
            for (int columns = 0; columns <= 300; ++columns) {
                for (const double done : {0.0, 0.5, 1.0}) {
                    const std::string line = progress_line(progress_of(done, rate, left), columns);
                    CAPTURE(line);
                    CHECK(static_cast<int>(line.size()) <= (columns > 0 ? columns - 1 : 0));
                }
            }
        }
    }
}

TEST_CASE("a wide terminal shows all, a narrow one what matters most") {
    const RenderProgress state = progress_of(0.25, 1'500'000, 75);
    CHECK(progress_line(state, 200) ==
          "[##########..............................]  25.0 %  1.50 Mrays/s  1:15 left");
    CHECK(progress_line(state, 60) ==
          "[######..................]  25.0 %  1.50 Mrays/s  1:15 left");
    CHECK(progress_line(state, 40) == "[####..............]  25.0 %  1:15 left");
    CHECK(progress_line(state, 25) == " 25.0 %  1:15 left");
    CHECK(progress_line(state, 12) == " 25.0 %");
    CHECK(progress_line(state, 5).empty());
}

TEST_CASE("before the time left is known nothing is said of it") {
    CHECK(progress_line(progress_of(0, 500, {}), 20) == "[.........]   0.0 %");
    CHECK(progress_line(progress_of(0, 500, {}), 80).find("left") == std::string::npos);
}

TEST_CASE("times are minutes and seconds, and hours where there are any") {
    CHECK(time_text(6.6) == "0:07");
    CHECK(time_text(750) == "12:30");
    CHECK(time_text(3600) == "1:00:00");
    CHECK(time_text(-5) == "0:00");
    CHECK(time_text(1e30) == "1000:00:00");
}
