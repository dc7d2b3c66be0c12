#include "io/picture/film.h"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using lightwalk::test::TemporaryFolder;

namespace {

/// A folder with a program ffmpeg, where the path of programs leads while this lives.
class Encoder {
  public:
    /// @param script  of the shell; its last word, without "file:", is $file
    explicit Encoder(const std::string& script) {
        const std::string path = folder.write(
            "ffmpeg", "#!/bin/sh\nfor word; do :; done\nfile=${word#file:}\n" + script);
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        set_path(folder.path() + ":/usr/bin:/bin");
    }
    ~Encoder() { set_path(before_); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    TemporaryFolder folder;

  private:
    static void set_path(const std::string& value) { setenv("PATH", value.c_str(), 1); }
    std::string before_ = getenv("PATH") != nullptr ? getenv("PATH") : "";
};

Picture picture_of(int width, int height) {
    return {width, height,
            std::vector<Rgb>(static_cast<std::size_t>(width * height), Rgb::grey(1))};
}

DisplayTone linear() {
    return {1, std::nullopt};
}

std::string bytes_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("film: its name ends in mp4") {
    CHECK(is_film("walk.mp4"));
    CHECK(is_film("a/b.MP4"));
    CHECK_FALSE(is_film("walk%d.png"));
    CHECK_FALSE(is_film("mp4"));
}

TEST_CASE("film: the encoder gets every frame, and the file appears when the film is whole") {
    const Encoder encoder("cat >\"$file\"\n");
    const std::string path = encoder.folder.path("walk.mp4");
    std::vector<std::string> unfinished;
    Film film(path, 6, 4, 25, [&](const std::string& file) { unfinished.push_back(file); });
    film.add(picture_of(6, 4), linear());
    film.add(picture_of(6, 4), linear());
    CHECK_FALSE(std::filesystem::exists(path));
    REQUIRE(unfinished.size() == 1);
    CHECK(unfinished[0].find(path) == 0);
    film.finish();
    CHECK(bytes_of(path) == std::string(2 * 6 * 4 * 3, '\xff'));
    CHECK(encoder.folder.files() == std::vector<std::string>{"ffmpeg", "walk.mp4"});
    CHECK(unfinished.back().empty());
}

TEST_CASE("film: one that is given up leaves nothing, frames of another size are refused") {
    const Encoder encoder("cat >\"$file\"\n");
    {
        Film film(encoder.folder.path("walk.mp4"), 6, 4, 25);
        film.add(picture_of(6, 4), linear());
        CHECK_THROWS_AS(film.add(picture_of(4, 6), linear()), InputError);
    }
    CHECK(encoder.folder.files() == std::vector<std::string>{"ffmpeg"});
}

TEST_CASE("film: an encoder that fails is an error, and no signal") {
    const Encoder encoder("exit 3\n");
    const std::string path = encoder.folder.path("walk.mp4");
    Film film(path, 512, 512, 25);
    const auto whole = [&] {
        for (int i = 0; i < 4; ++i) film.add(picture_of(512, 512), linear());
        film.finish();
    };
    CHECK_THROWS_WITH_AS(whole(), (path + ": ffmpeg has failed").c_str(), InputError);
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("film: without an encoder it is said what to install") {
    const Encoder encoder("exit 0\n");
    std::filesystem::remove(encoder.folder.path("ffmpeg"));
    const Encoder other("exit 0\n");
    std::filesystem::remove(other.folder.path("ffmpeg"));
    setenv("PATH", other.folder.path().c_str(), 1);
    CHECK_THROWS_AS((void)film_encoder(), InputError);
}
