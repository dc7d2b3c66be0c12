#include "io/generators/sky_command.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

using Words = std::vector<std::string>;

std::string joined(const Words& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

}  // namespace

TEST_CASE("sky command: gensky at another time keeps its place, its numbers and its clock") {
    const SkyCommand sky(
        {"gensky", "9", "21", "14:18", "+s", "-a", "46", "-o", "-7", "-m", "-15", "-g", ".15"});
    CHECK(sky.time().month == 9);
    CHECK(sky.time().day == 21);
    CHECK(sky.time().hour == doctest::Approx(14.3));
    CHECK(sky.time().type == "+s");
    CHECK(sky.has_types());
    CHECK(joined(sky.at({6, 1, 8.25, ""})) == "gensky 6 1 8.2500 +s -a 46 -o -7 -m -15 -g .15");
    // Not the value of -a, though it begins with a minus.
    const SkyCommand south({"gensky", "1", "2", "+3", "-a", "-30", "-c"});
    CHECK(joined(south.at({1, 2, 23.99999, "-u"})) == "gensky 1 2 +23.9999 -a -30 -u");
    const SkyCommand zone({"gensky", "1", "2", "13CET", "-y", "2020"});
    CHECK(joined(zone.at({1, 2, 7, ""})) == "gensky 1 2 7.0000CET -y 2020");
}

TEST_CASE("sky command: gendaylit keeps its weather, and has no kinds of sky") {
    const SkyCommand sky({"gendaylit", "6", "21", "12", "-W", "800", "100", "-s"});
    CHECK_FALSE(sky.has_types());
    CHECK(joined(sky.at({12, 24, 9.5, "+i"})) == "gendaylit 12 24 9.5000 -W 800 100 -s");
}

TEST_CASE("sky command: angles are no time, and wrong words are told") {
    CHECK_THROWS_AS(SkyCommand({"gensky", "-ang", "45", "0"}), InputError);
    CHECK_THROWS_AS(SkyCommand({"gendaylit", "-ang", "45", "0", "-W", "1", "2"}), InputError);
    CHECK_THROWS_AS(SkyCommand({"gensky", "-defaults"}), InputError);
    CHECK_THROWS_AS(SkyCommand({"gensky", "13", "1", "12"}), InputError);
    CHECK_THROWS_AS(SkyCommand({"gensky"}), InputError);
    CHECK_THROWS_AS(SkyCommand({"gendaylit", "1", "1"}), InputError);
}

TEST_CASE("sky command: at sunrise and sunset the sun's middle is on the horizon") {
    for (const Words& place : {Words{"-a", "46", "-o", "-7", "-m", "-15"},
                               Words{"-a", "-33", "-o", "-151", "-m", "-150", "-y", "2021"}}) {
        Words words{"gensky", "1", "1", "12"};
        words.insert(words.end(), place.begin(), place.end());
        const SkyCommand sky(words);
        for (const int month : {1, 3, 6, 9, 12}) {
            const SunTimes day = sky.sun({month, 21, 12, ""});
            REQUIRE(day.rise);
            REQUIRE(day.set);
            for (const double hour : {*day.rise, *day.set})
                CHECK(std::abs(sky.sun({month, 21, hour, ""}).altitude) < 0.006);
            CHECK(sky.sun({month, 21, *day.rise + 1, ""}).altitude > 0.05);
            CHECK(sky.sun({month, 21, *day.set + 1, ""}).altitude < -0.05);
        }
    }
    const SkyCommand north({"gensky", "6", "21", "12", "-a", "80"});
    CHECK_FALSE(north.sun({6, 21, 0, ""}).rise);
    CHECK(north.sun({6, 21, 0, ""}).altitude > 0);
    CHECK(north.sun({12, 21, 12, ""}).altitude < 0);
    CHECK_FALSE(north.sun({12, 21, 12, ""}).set);
}
