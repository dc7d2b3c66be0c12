#include "core/problem_list.h"

#include <doctest/doctest.h>

using namespace lightwalk;

TEST_CASE("problems: in order of appearance, the first few of a kind told, the others counted") {
    ProblemList problems;
    CHECK(problems.empty());
    CHECK_NOTHROW(problems.raise());
    problems.add({"a.rad", 3}, "unknown type \"x\"", "type x");
    problems.add({"a.rad", 4}, "BSDF one", "BSDF", 2);
    problems.add({"a.rad", 5}, "unknown type \"x\"", "type x");
    for (const int line : {6, 7, 8}) problems.add({"b.rad", line}, "BSDF more", "BSDF", 2);
    problems.add(InputError({"c.oct", 0}, "truncated"));
    const std::string expected =
        "a.rad:3: unknown type \"x\" (and 1 more)\n"
        "a.rad:4: BSDF one\n"
        "b.rad:6: BSDF more (and 2 more)\n"
        "c.oct: truncated";
    CHECK(problems.text() == expected);
    CHECK_THROWS_WITH_AS(problems.raise(), expected.c_str(), InputError);
}
