#include "io/files/atomic_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "io/files/library_path.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("files appear whole, replace older ones, and leave nothing beside them") {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.txt");
    write_file_atomically(path, "first, longer");
    CHECK(read_file(path) == "first, longer");
    write_file_atomically(path, "second");
    CHECK(read_file(path) == "second");
    CHECK(folder.files().size() == 1);
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    CHECK((status.st_mode & 0777) == (0666 & ~mask));
}

TEST_CASE("links are followed, devices written to directly") {
    const TemporaryFolder folder;
    write_file_atomically(folder.path("real"), "old");
    fs::create_symlink("real", folder.path("link"));
    write_file_atomically(folder.path("link"), "new");
    CHECK(fs::is_symlink(folder.path("link")));
    CHECK(read_file(folder.path("real")) == "new");
    write_file_atomically("/dev/null", "gone");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("whether a file can be written is known before there is anything to write") {
    const TemporaryFolder folder;
    check_writable(folder.path("new"));
    CHECK(folder.files().empty());
    folder.write("old", "kept");
    check_writable(folder.path("old"));
    CHECK(read_file(folder.path("old")) == "kept");
    CHECK(folder.files().size() == 1);
    check_writable("/dev/null");
    check_writable("/dev/stdout");
    fs::create_directory(folder.path("folder"));
    for (const std::string& wrong : {folder.path("missing/file"), folder.path("old/file"),
                                     folder.path("folder"), std::string("/dev/fd/987")}) {
        CAPTURE(wrong);
        CHECK_THROWS_AS(check_writable(wrong), InputError);
        CHECK_THROWS_AS(write_file_atomically(wrong, "x"), InputError);
    }
}

TEST_CASE("what an open descriptor's name gets stands behind what was written to it before") {
    const TemporaryFolder folder;
    const std::string path = folder.path("log");
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    REQUIRE(descriptor >= 0);
    REQUIRE(::write(descriptor, "first ", 6) == 6);
    for (const std::string directory : {"/dev/fd/", "/proc/self/fd/"})
        write_file_atomically(directory + std::to_string(descriptor), "more ");
    REQUIRE(::write(descriptor, "last", 4) == 4);
    ::close(descriptor);
    CHECK(read_file(path) == "first more more last");
    CHECK_THROWS_AS(write_file_atomically("/dev/fd/" + std::to_string(descriptor), "x"),
                    InputError);
    CHECK(folder.files().size() == 1);
}

TEST_CASE("a failed write names the file and leaves nothing") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH_AS(write_file_atomically(folder.path("no/such/folder"), "x"),
                         doctest::Contains("no/such/folder: cannot write: No such file"),
                         InputError);
    fs::create_directory(folder.path("taken"));
    CHECK_THROWS_WITH_AS(write_file_atomically(folder.path("taken"), "x"),
                         doctest::Contains("taken: cannot write: "), InputError);
    CHECK(folder.files().size() == 1);
    CHECK_THROWS_AS(write_file_atomically("/dev/full", "x"), InputError);
}
