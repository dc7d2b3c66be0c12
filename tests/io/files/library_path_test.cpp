#include "io/files/library_path.h"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace lightwalk {
namespace {

using Elements = std::vector<std::string>;

TEST_CASE(
    "elements of the search path: empty ones are the current directory, a trailing one is none") {
    CHECK(split_search_path("") == Elements{"."});
    CHECK(split_search_path("a:b") == Elements{"a", "b"});
    CHECK(split_search_path("a:b:") == Elements{"a", "b"});
    CHECK(split_search_path(":a") == Elements{".", "a"});
    CHECK(split_search_path("a::b") == Elements{"a", ".", "b"});
    CHECK(split_search_path(":") == Elements{"."});
}

TEST_CASE("paths are seen from a directory unless they are absolute") {
    CHECK(path_from("", "a/b") == "a/b");
    CHECK(path_from(".", "a/b") == "a/b");
    CHECK(path_from("d", "a/b") == "d/a/b");
    CHECK(path_from("d/", "a") == "d/a");
    CHECK(path_from("d", "/a") == "/a");
    CHECK(path_from("d", ".") == "d");
    CHECK(path_from("d", "../e") == "d/../e");
    CHECK(directory_of("a/b/c") == "a/b");
    CHECK(directory_of("c") == "");
    CHECK(directory_of("/c") == "/");
}

TEST_CASE("the first element that holds the file wins, and names may hold folders") {
    const test::TemporaryFolder folder;
    const std::string one = folder.write("one/x.cal", "1");
    const std::string two = folder.write("two/x.cal", "2");
    const std::string sub = folder.write("two/sub/y.cal", "3");
    const LibraryPath path(
        {folder.path() + "/none", folder.path() + "/one", folder.path() + "/two"});
    CHECK(path.find("x.cal") == one);
    CHECK(path.find("sub/y.cal") == sub);
    CHECK(path.find(two) == two);
    CHECK_FALSE(path.find("sub"));  // a directory
    CHECK_FALSE(path.find("z.cal"));
    CHECK_FALSE(path.find(""));
}

TEST_CASE("names that begin with a dot or a slash are not searched") {
    const test::TemporaryFolder folder;
    folder.write("lib/x.cal", "1");
    const std::string here = folder.write("work/x.cal", "2");
    const LibraryPath path = LibraryPath({"../lib"}).relative_to(folder.path() + "/work");
    CHECK(path.find("x.cal") == folder.path() + "/work/../lib/x.cal");
    CHECK(path.find("./x.cal") == folder.path() + "/work/./x.cal");
    CHECK_FALSE(path.find("/x.cal"));
    CHECK_FALSE(LibraryPath({folder.path() + "/lib"}).find("./x.cal"));
}

/// Sets an environment variable for the length of a test.
class ScopedVariable {
  public:
    ScopedVariable(const char* name, const std::string& value) : name_(name) {
        const char* const old =
            std::getenv(name);  // NOLINT(concurrency-mt-unsafe): tests are serial
        if (old != nullptr) old_ = old;
        setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    }
    ~ScopedVariable() {
        if (old_)
            setenv(name_, old_->c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
        else
            unsetenv(name_);  // NOLINT(concurrency-mt-unsafe)
    }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> old_;
};

TEST_CASE("~ is the home directory, and is not searched") {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("x.cal", "1");
    const ScopedVariable home("HOME", folder.path());
    CHECK(LibraryPath({"."}).find("~/x.cal") == file);
    CHECK_FALSE(LibraryPath({"."}).find("~/y.cal"));
    CHECK_FALSE(LibraryPath({"."}).find("~no_such_user_here/x.cal"));
}

TEST_CASE("RAYPATH comes first, the project's own library last") {
    const ScopedVariable variable("RAYPATH", "one::/two:");
    const Elements directories = LibraryPath::from_environment().directories();
    REQUIRE(directories.size() >= 3);
    CHECK(directories[0] == "one");
    CHECK(directories[1] == ".");
    CHECK(directories[2] == "/two");
    CHECK(directories.size() <= 4);
}

TEST_CASE("a path can be seen from one directory after another, always as it was first given") {
    const LibraryPath path({".", "lib", "/usr/share"});
    const LibraryPath from = path.relative_to("a").relative_to("b");
    CHECK(from.directories() == Elements{"b", "b/lib", "/usr/share"});
    CHECK(from.base() == "b");
    CHECK(path.describe() == ".:lib:/usr/share");
    CHECK(from.relative_to("").describe() == ".:lib:/usr/share");
}

TEST_CASE("a missing file names its kind and the path") {
    CHECK_THROWS_WITH_AS(
        static_cast<void>(LibraryPath({".", "/nowhere"}).locate("no_such.cal", "function file")),
        "cannot find function file \"no_such.cal\" in .:/nowhere", InputError);
}

TEST_CASE("whole files are read as bytes, up to a limit") {
    const test::TemporaryFolder folder;
    const std::string bytes("a\0b\r\n", 5);
    const std::string file = folder.write("f", bytes);
    CHECK(read_file(file) == bytes);
    CHECK(read_file(file, 5) == bytes);
    CHECK_THROWS_WITH_AS(read_file(file, 4), (file + ": larger than 4 bytes").c_str(), InputError);
    CHECK_THROWS_WITH_AS(read_file(folder.path()),
                         (folder.path() + ": cannot open: is a directory").c_str(), InputError);
    CHECK_THROWS_WITH_AS(read_file("no/such/file"),
                         "no/such/file: cannot open: No such file or directory", InputError);
    CHECK_THROWS_AS(read_file("/dev/zero", 1000), InputError);
    CHECK(is_readable_file(file));
    CHECK_FALSE(is_readable_file("/dev/null"));
    CHECK_FALSE(is_readable_file(folder.path()));
}

}  // namespace
}  // namespace lightwalk
