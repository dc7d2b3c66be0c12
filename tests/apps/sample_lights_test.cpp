// lightwalk render --sample-lights, from outside.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE("render: of many lights the samples of a pixel choose a few, alike whoever traces them") {
    const TemporaryFolder folder;
    std::string text =
        "void plastic grey 0 0 5 .5 .4 .3 .1 .1\nvoid light lamp 0 0 3 20 20 20\n"
        "grey polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\ngrey sphere ball 0 0 4 0 0 1 "
        "1\n";
    for (int i = 0; i < 25; ++i)
        text += "lamp sphere l" + std::to_string(i) + " 0 0 4 " + std::to_string(i % 6 - 2.5) +
                ' ' + std::to_string(i / 6 - 2) + " 4 .1\n";
    const std::string scene = folder.write("room.rad", text);
    const auto pixels = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", "-vp", "0", "-6", "2", "-x", "48", "-y", "32"});
        words.push_back(scene);
        const ProgramResult made = run_program(words);
        CHECK(made.status == 0);
        return made.out.substr(made.out.find("\n\n"));
    };
    const std::string few = pixels({"--samples", "4", "-n", "1"});
    CHECK(pixels({"--samples", "4", "-n", "3", "--block", "16"}) == few);
    CHECK(pixels({"--samples", "4", "--sample-lights", "8"}) == few);
    CHECK(pixels({"--samples", "4", "--sample-lights", "0"}) != few);
    CHECK(pixels({"--samples", "4", "--sample-lights", "13"}) ==  // 25 are no more than twice 13
          pixels({"--samples", "4", "--sample-lights", "0"}));
    CHECK(pixels({"-ps", "1", "--sample-lights", "2"}) == pixels({"-ps", "1"}));
}
