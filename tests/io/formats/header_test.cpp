#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/formats/header.h"

using namespace lightwalk;

TEST_CASE("headers give lines, format and size, with either kind of line end") {
    for (const std::string end : {"\n", "\r\n"}) {
        const std::string text = "#?RADIANCE" + end + "oconv a.rad" + end + "FORMAT=  ascii \t" +
                                 end + "\tFORMAT=float" + end + end;
        const InfoHeader header = decode_header(text + "DATA\n\n", "t");
        CHECK(header.lines ==
              std::vector<std::string>{"#?RADIANCE", "oconv a.rad", "\tFORMAT=float"});
        CHECK(header.format == "ascii");
        CHECK(header.size == text.size());
    }
}

TEST_CASE("the first line may be anything printable, FORMAT may be missing, the last one counts") {
    CHECK(decode_header("history\n\n", "t").format.empty());
    CHECK(decode_header("FORMAT=a\nFORMAT=b\n\n", "t").format == "b");
    CHECK(decode_header("FORMAT=" + std::string(100, 'x') + "\n\n", "t").format.size() == 63);
    CHECK(decode_header("format=a\nFORMATS=b\n\n", "t").format.empty());
}

TEST_CASE("what is no header is refused") {
    const auto check_error = [](const std::string& text, const char* message) {
        CAPTURE(text.substr(0, 50));
        CHECK_THROWS_WITH_AS((void)decode_header(text, "t.oct"), message, InputError);
    };
    check_error("", "t.oct: no information header");
    check_error("\n", "t.oct: no information header");
    check_error("\x01\x1f", "t.oct: no information header");
    check_error("#?RADIANCE\nx\n",
                "t.oct: the information header has no end, expected an empty line");
    check_error("#?RADIANCE", "t.oct: the information header has no end, expected an empty line");
    check_error("a\n" + std::string(1 << 20, 'x') + "\n\n",
                "t.oct: the information header is longer than 1 MiB");
}

TEST_CASE("header variables stand at the first column, with their exact name") {
    CHECK(header_variable("VIEW= -vtv ", "VIEW") == "-vtv");
    CHECK(header_variable("VIEW=", "VIEW") == "");
    CHECK(header_variable("VIEW=  ", "VIEW") == "");
    CHECK_FALSE(header_variable("\tVIEW= -vtv", "VIEW"));
    CHECK_FALSE(header_variable("VIEWS= -vtv", "VIEW"));
    CHECK_FALSE(header_variable("view= -vtv", "VIEW"));
    CHECK_FALSE(header_variable("VIEW", "VIEW"));
}
