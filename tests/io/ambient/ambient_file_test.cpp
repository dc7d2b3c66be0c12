#include "io/ambient/ambient_file.h"

#include <doctest/doctest.h>

#include <string>

#include "core/error.h"

namespace lightwalk {
namespace {

/// What is said of a file whose header ends in `line` and that holds nothing else.
std::string error_with(const std::string& line) {
    try {
        (void)decode_ambient_file("#?RADIANCE\n" + line + "FORMAT=Radiance_ambval\n\n", "x.amb");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST_CASE("an ambient file of other than three channels is refused, and a count that is no count") {
    for (const char* count : {"1", "4", "3x", "three", ""}) {
        CAPTURE(std::string(count));
        CHECK(error_with("NCOMP=" + std::string(count) + "\n").find("three channels") !=
              std::string::npos);
    }
    for (const char* line : {"", "NCOMP=3\n", "NCOMP= 3 \n"}) {
        CAPTURE(std::string(line));
        CHECK(error_with(line).find("three channels") == std::string::npos);
    }
}

}  // namespace
}  // namespace lightwalk
