#include "io/files/settled_files.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/temporary_folder.h"

using namespace lightwalk;
using std::chrono::milliseconds;

namespace {

FileStates state(std::uintmax_t size, bool exists = true) {
    return {{"room.rad", {exists, {}, size}}};
}

/// Looks at times in ms.
struct Looks {
    SettledFiles files{state(1)};
    SettledFiles::Clock::time_point begin;
    bool look(int ms, const FileStates& now) {
        return files.are_to_be_read(now, begin + milliseconds(ms));
    }
};

}  // namespace

TEST_CASE("settled files: what is written in pieces is read when it is whole") {
    Looks looks;
    CHECK_FALSE(looks.look(0, state(1)));
    CHECK_FALSE(looks.files.change());
    for (int i = 1; i < 20; ++i) {
        CHECK_FALSE(looks.look(100 * i, state(static_cast<std::uintmax_t>(100 * i))));
        CHECK(looks.files.change());
    }
    CHECK_FALSE(looks.look(2100, state(1900)));
    CHECK(looks.look(2201, state(1900)));
}

TEST_CASE("settled files: one that is gone for a moment, and comes back as it was, is the same") {
    Looks looks;
    CHECK_FALSE(looks.look(0, state(0, false)));
    CHECK_FALSE(looks.look(100, state(1)));
    CHECK_FALSE(looks.look(900, state(1)));
    CHECK_FALSE(looks.look(1000, state(0, false)));
    CHECK(looks.look(1400, state(0, false)));
}

TEST_CASE("settled files: those that change all the time are read after all") {
    Looks looks;
    bool read = false;
    int i = 0;
    for (; i < 200 && !read; ++i)
        read = looks.look(100 * i, state(static_cast<std::uintmax_t>(i + 2)));
    CHECK(read);
    CHECK(100 * i > 9000);
}

TEST_CASE("settled files: another file renamed over one that was read is a change") {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("room.rad", "one"), other = folder.write("new", "other");
    WatchedFiles watched;
    (void)watched.read(file);
    SettledFiles settled(watched.recorded());
    const SettledFiles::Clock::time_point begin;
    CHECK_FALSE(settled.are_to_be_read(watched.now(), begin));
    std::filesystem::rename(other, file);
    CHECK_FALSE(settled.are_to_be_read(watched.now(), begin + milliseconds(500)));
    CHECK(settled.are_to_be_read(watched.now(), begin + milliseconds(801)));
    WatchedFiles again;
    again.record(watched.recorded());
    CHECK(again.have_changed());
    CHECK(again.recorded() == watched.recorded());
}
