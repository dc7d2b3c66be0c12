#include "io/files/file_manifest.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>

#include "core/error.h"
#include "io/files/digest.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
namespace fs = std::filesystem;

TEST_CASE("a manifest holds what was read, and what was looked for in vain") {
    const test::TemporaryFolder folder;
    const std::string room = folder.write("room.rad", "one"), none = folder.path("none.cal");
    ManifestRecorder recorder;
    CHECK(recorder.readable(room));
    CHECK(recorder.files().empty());
    CHECK(recorder.read(folder.path("./room.rad")) == "one");
    CHECK_FALSE(recorder.readable(none));
    CHECK_THROWS_AS((void)recorder.read(folder.path("gone.rad")), InputError);
    const std::vector<ManifestFile> files = recorder.files();
    REQUIRE(files.size() == 2);
    CHECK(files[0].path == none);
    CHECK_FALSE(files[0].exists);
    CHECK(files[1].path == room);
    CHECK(files[1].exists);
    CHECK(files[1].size == 3);
    CHECK(files[1].digest == digest_of_bytes("one"));
}

TEST_CASE(
    "changes since: the date decides cheaply, then the digest, and what has changed is named") {
    const test::TemporaryFolder folder;
    const std::string room = folder.write("room.rad", "one"), none = folder.path("none.cal");
    ManifestRecorder recorder;
    (void)recorder.read(room);
    (void)recorder.readable(none);
    const std::vector<ManifestFile> files = recorder.files();
    using Changes = std::vector<std::string>;
    CHECK(changes_since(files).empty());

    const fs::file_time_type date = fs::last_write_time(room);
    folder.write("room.rad", "one");
    fs::last_write_time(room, date + std::chrono::seconds(5));
    CHECK(changes_since(files).empty());
    folder.write("room.rad", "two");
    fs::last_write_time(room, date + std::chrono::seconds(5));
    CHECK(changes_since(files) == Changes{room + " has changed"});
    fs::last_write_time(room, date);  // who sets the date back wants it so
    CHECK(changes_since(files).empty());
    folder.write("room.rad", "three");
    fs::last_write_time(room, date);
    CHECK(changes_since(files) == Changes{room + " has changed"});

    fs::remove(room);
    folder.write("none.cal", "");
    CHECK(changes_since(files) == Changes{none + " is new", room + " is missing"});
}
