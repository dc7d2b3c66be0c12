#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"

using namespace lightwalk;
namespace fs = std::filesystem;

namespace {

/// An empty folder that vanishes with the test.
class Folder {
  public:
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "lightwalk-XXXXXX").string();
        REQUIRE(::mkdtemp(pattern.data()) != nullptr);
        path_ = pattern;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (path_ / name).string();
    }
    [[nodiscard]] int entries() const {
        return static_cast<int>(
            std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
    }

  private:
    fs::path path_;
};

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Picture picture() {
    Picture picture{20, 10, {}};
    for (int i = 0; i < 200; ++i) picture.pixels.push_back({static_cast<float>(i), 1, 0.25f});
    return picture;
}

}  // namespace

TEST_CASE("files appear whole, replace older ones, and leave nothing beside them") {
    const Folder folder;
    const std::string path = folder.file("a.txt");
    write_file_atomically(path, "first, longer");
    CHECK(contents(path) == "first, longer");
    write_file_atomically(path, "second");
    CHECK(contents(path) == "second");
    CHECK(folder.entries() == 1);
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    CHECK((status.st_mode & 0777) == (0666 & ~mask));
}

TEST_CASE("links are followed, devices written to directly") {
    const Folder folder;
    write_file_atomically(folder.file("real"), "old");
    fs::create_symlink("real", folder.file("link"));
    write_file_atomically(folder.file("link"), "new");
    CHECK(fs::is_symlink(folder.file("link")));
    CHECK(contents(folder.file("real")) == "new");
    write_file_atomically("/dev/null", "gone");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("a failed write names the file and leaves nothing") {
    const Folder folder;
    CHECK_THROWS_WITH_AS(write_file_atomically(folder.file("no/such/folder"), "x"),
                         doctest::Contains("no/such/folder: cannot write: No such file"),
                         InputError);
    fs::create_directory(folder.file("taken"));
    CHECK_THROWS_WITH_AS(write_file_atomically(folder.file("taken"), "x"),
                         doctest::Contains("taken: cannot write: "), InputError);
    CHECK(folder.entries() == 1);
    CHECK_THROWS_AS(write_file_atomically("/dev/full", "x"), InputError);
}

TEST_CASE("the extension tells the kind of picture") {
    const Folder folder;
    const PictureHeader header{{"history"}};
    for (const std::string name : {"a.hdr", "a.pic", "a.HDR"}) {
        write_picture(folder.file(name), picture(), header, {});
        CHECK(contents(folder.file(name)) == encode_hdr(picture(), header));
    }
    write_picture(folder.file("a.exr"), picture(), header, {});
    CHECK(contents(folder.file("a.exr")).starts_with("\x76\x2f\x31\x01"));
    write_picture(folder.file("a.png"), picture(), header, {});
    CHECK(contents(folder.file("a.png")).starts_with("\x89PNG\r\n"));
    for (const std::string name : {"a.jpg", "a.jpeg"}) {
        write_picture(folder.file(name), picture(), header, {});
        CHECK(contents(folder.file(name)).starts_with("\xff\xd8\xff"));
    }
    CHECK(folder.entries() == 7);
    for (const std::string name : {"a.tif", "a", ".hdr", "hdr"}) {
        CHECK_THROWS_WITH_AS(write_picture(folder.file(name), picture(), header, {}),
                             doctest::Contains("unknown kind of picture"), InputError);
    }
    CHECK_THROWS_AS(write_picture(folder.file("empty.png"), {}, header, {}), InputError);
    CHECK_THROWS_AS(write_picture(folder.file("empty.exr"), {}, header, {}), InputError);
    CHECK(folder.entries() == 7);
}

TEST_CASE("the same picture and header give the same .exr, whenever it is written") {
    const Folder folder;
    const PictureHeader header{{"history", "CAPDATE= 2001:02:03 04:05:06"}};
    write_picture(folder.file("a.exr"), picture(), header, {});
    const std::string bytes = contents(folder.file("a.exr"));
    CHECK(bytes.find("2001:02:03 04:05:06") !=
          bytes.rfind("2001:02:03 04:05:06"));  // history, attribute
    CHECK(bytes.find("chromaticities") != std::string::npos);
}

TEST_CASE("raw depth is native floats from the top row, .exr has one channel Z") {
    const Folder folder;
    const std::vector<float> depth{1, 2.5f, 1e10f, 0, 4, 5};
    write_depth(folder.file("depth.z"), 3, 2, depth);
    const std::string bytes = contents(folder.file("depth.z"));
    REQUIRE(bytes.size() == 24);
    CHECK(std::memcmp(bytes.data(), depth.data(), 24) == 0);
    write_depth(folder.file("depth.exr"), 3, 2, depth);
    const std::string exr = contents(folder.file("depth.exr"));
    CHECK(exr.starts_with("\x76\x2f\x31\x01"));
    CHECK(exr.find(std::string("chlist\0\x13\0\0\0Z\0\x02\0\0\0", 17)) != std::string::npos);
}
