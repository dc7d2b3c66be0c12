#include "io/files/mapped_file.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using test::TemporaryFolder;

namespace {

std::string_view text_of(const MappedFile& file) {
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

}  // namespace

TEST_CASE("a mapped file holds the file's bytes, also after another one has taken its name") {
    const TemporaryFolder folder;
    const std::string path = folder.write("a", std::string("one\0two", 7));
    const MappedFile file(path);
    CHECK(file.path() == path);
    CHECK(text_of(file) == std::string_view("one\0two", 7));
    write_file_atomically(path, "three");
    CHECK(text_of(file) == std::string_view("one\0two", 7));
    CHECK(text_of(MappedFile(path)) == "three");
    std::filesystem::remove(path);
    CHECK(text_of(file).starts_with("one"));
}

TEST_CASE("what cannot be mapped is named, and nothing is waited for") {
    const TemporaryFolder folder;
    const auto refused = [](const std::string& path) {
        try {
            const MappedFile file(path);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(refused(folder.path("none")) ==
          folder.path("none") + ": cannot open: No such file or directory");
    CHECK(refused(folder.path()) == folder.path() + ": cannot open: is a directory");
    CHECK(refused(folder.write("empty", "")) == folder.path("empty") + ": is empty");
    REQUIRE(mkfifo(folder.path("pipe").c_str(), 0600) == 0);
    CHECK(refused(folder.path("pipe")) == folder.path("pipe") + ": cannot open: no regular file");
    CHECK(refused("/dev/zero") == "/dev/zero: cannot open: no regular file");
}
