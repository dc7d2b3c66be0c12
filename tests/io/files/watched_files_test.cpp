#include "io/files/watched_files.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>

#include "tests/temporary_folder.h"

using namespace lightwalk;

TEST_CASE("watched files: written, longer, gone and new ones are noticed, others are not") {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("room.rad", "one"), other = folder.path("no.rad");
    const auto watch = [&] {
        auto files = std::make_unique<WatchedFiles>();
        (void)files->read(file);
        (void)files->readable(other);
        return files;
    };
    auto watched = watch();
    CHECK_FALSE(watched->have_changed());
    folder.write("unread.rad", "three");
    CHECK_FALSE(watched->have_changed());

    folder.write("room.rad", "longer");
    CHECK(watched->have_changed());
    watched = watch();
    std::filesystem::last_write_time(
        file, std::filesystem::last_write_time(file) + std::chrono::seconds(5));
    CHECK(watched->have_changed());

    watched = watch();
    folder.write("no.rad", "new");
    CHECK(watched->have_changed());
    std::filesystem::remove(other);
    CHECK_FALSE(watched->have_changed());
    std::filesystem::remove(file);
    CHECK(watched->have_changed());
}
