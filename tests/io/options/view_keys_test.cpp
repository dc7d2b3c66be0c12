#include "io/options/view_keys.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace lightwalk;

TEST_CASE("path file: one key a line, with or without its time") {
    const std::vector<ViewKey> keys = read_view_keys(
        "# through the room\n"
        "VIEW= -vp 1 2 3 -vd 0 1 0 -vh 50\n"
        "\n"
        "2.5 rview -vtv -vp 2 2 3\n"
        "  VIEW= -vd 1 0 0\r\n",
        "walk.vf", View{});
    REQUIRE(keys.size() == 3);
    CHECK(keys[0].time == 0);
    CHECK(keys[1].time == 2.5);
    CHECK(keys[2].time == 3.5);
    CHECK(keys[0].view.horizontal == 50);
    CHECK(keys[2].view.horizontal == 50);
    CHECK(keys[2].view.position == Vec3{2, 2, 3});
    CHECK(keys[2].view.direction == Vec3{1, 0, 0});
}

TEST_CASE("path file: what is wrong is told by its line") {
    const auto read = [](const char* text) { return read_view_keys(text, "w.vf", View{}); };
    CHECK_THROWS_WITH_AS(read("VIEW= -vp 0 0 0\nhello\n"),
                         "w.vf:2: expected a view like \"VIEW= -vp x y z -vd x y z\", found "
                         "\"hello\"",
                         InputError);
    CHECK_THROWS_WITH_AS(read("VIEW= -vd 0 0 0\n"), "w.vf:1: zero view direction", InputError);
    CHECK_THROWS_WITH_AS(read("1 VIEW= -vp 0 0 0\n1 VIEW= -vp 1 0 0\n"),
                         "w.vf:2: the times of a path must rise", InputError);
    CHECK_THROWS_WITH_AS(read("# nothing\n"),
                         "w.vf: no line like \"VIEW= -vp x y z -vd x y z\": no path", InputError);
}
