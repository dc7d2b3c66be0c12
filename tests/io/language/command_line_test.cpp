#include "io/language/command_line.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwalk {
namespace {

using Words = std::vector<std::string>;

/// The words of every stage, one list after the other; "NEEDS A SHELL" when it does.
std::vector<Words> stages(const std::string& text) {
    const auto pipelines = split_command(text);
    if (!pipelines) return {{"NEEDS A SHELL"}};
    std::vector<Words> result;
    for (const Pipeline& pipeline : *pipelines) {
        for (const SimpleCommand& command : pipeline) {
            Words& words = result.emplace_back();
            for (const CommandWord& word : command) words.push_back(word.text);
        }
    }
    return result;
}

const std::vector<Words> kNeedsShell = {{"NEEDS A SHELL"}};

TEST_CASE("words, quotes and backslashes are the shell's") {
    CHECK(stages("genbox a b 1 2 3") == std::vector<Words>{{"genbox", "a", "b", "1", "2", "3"}});
    CHECK(stages("gensurf m n '10*s' \"sin(t)\" a\\ b") ==
          std::vector<Words>{{"gensurf", "m", "n", "10*s", "sin(t)", "a b"}});
    CHECK(stages("a 'x'\"y\"z ''") == std::vector<Words>{{"a", "xyz", ""}});
    CHECK(stages("a \"q\\\"\\n\\\\\"") == std::vector<Words>{{"a", "q\"\\n\\"}});
    CHECK(stages("a \\\n\tb\\\r\n c") == std::vector<Words>{{"a", "b", "c"}});
    CHECK(stages("a 'b\\\nc'") == std::vector<Words>{{"a", "b\\\nc"}});
    CHECK(stages("a b # c | d") == std::vector<Words>{{"a", "b"}});
    CHECK(stages("a b#c") == std::vector<Words>{{"a", "b#c"}});
    CHECK(stages("").empty());
}

TEST_CASE("pipes join programs, semicolons and lines separate them") {
    const auto two = split_command("a b | c d ; e");
    REQUIRE(two);
    REQUIRE(two->size() == 2);
    CHECK((*two)[0].size() == 2);
    CHECK((*two)[1].size() == 1);
    CHECK(split_command("a\nb")->size() == 2);
}

TEST_CASE("what needs a real shell is told") {
    for (const char* text :
         {"a > b",  "a < b", "a $X",    "a \"$X\"", "a `b`",   "a \"`b`\"", "a && b",
          "a || b", "a & b", "(a)",     "{ a; }",   "a ~/b",   "a 'b",      "a \"b",
          "a |",    "| a",   "a | | b", "! a",      "a ; | b", "a \\"}) {
        CAPTURE(text);
        CHECK(stages(text) == kNeedsShell);
    }
}

TEST_CASE("patterns become the names that match, or stay") {
    const test::TemporaryFolder folder;
    folder.write("b.rad", "");
    folder.write("a.rad", "");
    const auto expand = [&](const std::string& text) {
        return expand_patterns(split_command(text)->at(0).at(0), folder.path(), *real_files());
    };
    CHECK(expand("xform *.rad") == Words{"xform", "a.rad", "b.rad"});
    CHECK(expand("xform '*.rad'") == Words{"xform", "*.rad"});
    CHECK(expand("gensurf 2*t") == Words{"gensurf", "2*t"});
}

}  // namespace
}  // namespace lightwalk
