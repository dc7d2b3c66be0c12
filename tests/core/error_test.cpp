#include "core/error.h"

#include <doctest/doctest.h>

#include <string>

using namespace lightwalk;

TEST_CASE("messages: printable text stays as it is, every other byte is spelled") {
    for (const std::string text : {"room.rad:3: unknown type \"plastik\"", "a\tb\nc", "",
                                   "gr\xc3\xb6\xc3\x9f"
                                   "er \xe2\x82\xac \xf0\x9f\x92\xa1"}) {
        CHECK(printable(text) == text);
    }
    CHECK(printable(std::string("a\0b", 3)) == "a\\x00b");
    CHECK(printable("\x1b[2J\r\x7f") == "\\x1b[2J\\x0d\\x7f");
    // Latin-1, an overlong slash, a surrogate, a control character of two bytes, a cut sequence.
    CHECK(printable("gr\xf6\xdf") == "gr\\xf6\\xdf");
    CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");
    CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");
    CHECK(printable("\xc2\x9b") == "\\xc2\\x9b");
    CHECK(printable("x\xe2\x82") == "x\\xe2\\x82");
    CHECK(InputError({"a\x01.rad", 7}, "found \"\x02\"").what() ==
          std::string("a\\x01.rad:7: found \"\\x02\""));
}

TEST_CASE("messages: overlong words are cut, what follows them is not") {
    const std::string shown = printable("found \"" + std::string(100000, 'x') + "\" there");
    CHECK(shown.size() < 1100);
    CHECK(shown.starts_with("found \"xxx"));
    CHECK(shown.ends_with("xxx... there"));
}
