#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <thread>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/picture/encode_picture.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

Picture picture() {
    Picture picture{20, 10, {}};
    for (int i = 0; i < 200; ++i) picture.pixels.push_back({static_cast<float>(i), 1, 0.25f});
    return picture;
}

}  // namespace

TEST_CASE("the extension tells the kind of picture") {
    const TemporaryFolder folder;
    const PictureHeader header{{"history"}};
    for (const std::string name : {"a.hdr", "a.pic", "a.HDR", "a.unf", "a", ".hdr", "hdr", "a.",
                                   "a.b/a", "frame.007", "a.rgbe"}) {
        fs::create_directories(fs::path(folder.path(name)).parent_path());
        CHECK_NOTHROW(check_picture_name(folder.path(name)));
        CHECK(is_radiance_picture(folder.path(name)));
        write_picture(folder.path(name), picture(), header, {});
        CHECK(read_file(folder.path(name)) == encode_hdr(picture(), header));
    }
    write_picture(folder.path("a.exr"), picture(), header, {});
    CHECK(read_file(folder.path("a.exr")).starts_with("\x76\x2f\x31\x01"));
    write_picture(folder.path("a.png"), picture(), header, {});
    CHECK(read_file(folder.path("a.png")).starts_with("\x89PNG\r\n"));
    for (const std::string name : {"a.jpg", "a.jpeg"}) {
        write_picture(folder.path(name), picture(), header, {});
        CHECK(read_file(folder.path(name)).starts_with("\xff\xd8\xff"));
    }
    CHECK(folder.files().size() == 15);
    for (const std::string name : {"a.tif", "a.TIFF", "a.mp4", "a.hdr.gz", "a.b/a.c", "a.7z"}) {
        CHECK_THROWS_AS(check_picture_name(folder.path(name)), InputError);
        CHECK_THROWS_WITH_AS(write_picture(folder.path(name), picture(), header, {}),
                             doctest::Contains("unknown kind of picture"), InputError);
    }
    CHECK_THROWS_AS(write_picture(folder.path("empty.png"), {}, header, {}), InputError);
    CHECK_THROWS_AS(write_picture(folder.path("empty.exr"), {}, header, {}), InputError);
    CHECK(folder.files().size() == 15);
}

TEST_CASE("a pipe gets a Radiance picture, whatever its name") {
    const TemporaryFolder folder;
    const std::string pipe = folder.path("picture.pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::string bytes;
    std::thread reader([&] { bytes = read_file(pipe); });
    write_picture(pipe, picture(), {{"history"}}, {});
    reader.join();
    CHECK(bytes == encode_hdr(picture(), {{"history"}}));
    CHECK(fs::is_fifo(pipe));
}

TEST_CASE("the same picture and header give the same .exr, whenever it is written") {
    const TemporaryFolder folder;
    const PictureHeader header{{"history", "CAPDATE= 2001:02:03 04:05:06"}};
    write_picture(folder.path("a.exr"), picture(), header, {});
    const std::string bytes = read_file(folder.path("a.exr"));
    CHECK(bytes.find("2001:02:03 04:05:06") !=
          bytes.rfind("2001:02:03 04:05:06"));  // history, attribute
    CHECK(bytes.find("chromaticities") != std::string::npos);
}

TEST_CASE("in memory and in a file: the same bytes") {
    const TemporaryFolder folder;
    const PictureHeader header{{"history", "CAPDATE= 2001:02:03 04:05:06"}};
    const auto written = [&](const std::string& name) {
        write_picture(folder.path(name), picture(), header, {});
        return read_file(folder.path(name));
    };
    CHECK(encode_exr(picture(), header) == written("a.exr"));
    CHECK(encode_png(picture(), choose_tone(picture(), {})) == written("a.png"));
    CHECK(encode_jpeg(picture(), choose_tone(picture(), {})) == written("a.jpg"));
    CHECK(encode_jpeg(picture(), {}, 30).size() < encode_jpeg(picture(), {}, 100).size());
    CHECK_THROWS_WITH_AS((void)encode_png({}, {}), doctest::Contains("cannot encode png: "),
                         InputError);
    CHECK_THROWS_WITH_AS(write_picture(folder.path("b.png"), {}, header, {}),
                         doctest::Contains("b.png: cannot write: cannot encode png: "), InputError);
}

TEST_CASE("raw depth is native floats from the top row, .exr has one channel Z") {
    const TemporaryFolder folder;
    const std::vector<float> depth{1, 2.5f, 1e10f, 0, 4, 5};
    write_depth(folder.path("depth.z"), 3, 2, depth);
    const std::string bytes = read_file(folder.path("depth.z"));
    REQUIRE(bytes.size() == 24);
    CHECK(std::memcmp(bytes.data(), depth.data(), 24) == 0);
    write_depth(folder.path("depth.exr"), 3, 2, depth);
    const std::string exr = read_file(folder.path("depth.exr"));
    CHECK(exr.starts_with("\x76\x2f\x31\x01"));
    CHECK(exr.find(std::string("chlist\0\x13\0\0\0Z\0\x02\0\0\0", 17)) != std::string::npos);
}
