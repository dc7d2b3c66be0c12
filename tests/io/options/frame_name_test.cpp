#include "io/options/frame_name.h"

#include <doctest/doctest.h>

#include "io/options/option_words.h"

using namespace lightwalk;

TEST_CASE("one %d-style conversion is filled with the frame number") {
    CHECK(frame_name("a.hdr", 3) == "a.hdr");
    CHECK(frame_name("", 3).empty());
    CHECK(frame_name("f%d.hdr", 12) == "f12.hdr");
    CHECK(frame_name("f%03d.hdr", 7) == "f007.hdr");
    CHECK(frame_name("f%3d.hdr", 7) == "f  7.hdr");
    CHECK(frame_name("f%03d.hdr", 12345) == "f12345.hdr");
    CHECK(frame_name("100%%-%d", 1) == "100%-1");
    CHECK(varies_by_frame("f%02d"));
    CHECK_FALSE(varies_by_frame("f%%"));
}

TEST_CASE("other conversions are usage errors: they would read what is not there") {
    for (const std::string pattern :
         {"%s", "%n", "%d%d", "%", "%5", "%ld", "%*d", "%9999d", "%100d", "%-3d"}) {
        CAPTURE(pattern);
        CHECK_THROWS_AS((void)frame_name(pattern, 1), UsageError);
    }
}
