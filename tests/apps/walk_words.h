#pragma once
// A walk of small frames through a room of the tests: its command line and its results.
#include <string>
#include <vector>

#include "tests/apps/program.h"

namespace lightwalk::test {

inline std::vector<std::string> line(const std::vector<std::string>& more) {
    std::vector<std::string> words{"animate", "-vp", "0",  "-6", "2",   "-vd", "0",   "1", "-.2",
                                   "-x",      "64",  "-y", "48", "-vh", "45",  "-vv", "35"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The encoded pixels of a picture file, without the header, which has the time of creation.
inline std::string pixels_of(const std::string& path) {
    const std::string bytes = read_whole(path);
    return bytes.substr(bytes.find("\n\n"));
}

}  // namespace lightwalk::test
