#include "io/files/file_source.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/options/view_text.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"
#include "tests/all_primitives.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using lightwalk::test::TemporaryFolder;
using Question = FileSource::Question;

namespace {

struct Silent final : WarningSink {
    void warn(const std::string&) override {}
};

/// A scene whose description asks for everything that can be asked.
std::string write_scene(const TemporaryFolder& folder) {
    folder.write("lib/paint.cal", "paint = .5;");
    folder.write("lib/table.dat", "1 0 1 2 .5 .7");
    folder.write("one.part", "void plastic a 0 0 5 .1 .2 .3 0 0\n");
    folder.write("two.part", "void plastic b 0 0 5 .1 .2 .3 0 0\n");
    folder.write("points", "0 0 1 0 1 1");
    return folder.write("room.rad",
                        "!xform *.part\n"
                        "!genprism a prism points -l 0 0 1\n"
                        "!printf 'void glow c 0 0 4 1 2 3 0\\n'; true $HOME\n"
                        "a sphere ball 0 0 4 0 0 0 1\n");
}

/// What reading the scene gives, in words.
std::string read_all(const TemporaryFolder& folder, const std::shared_ptr<FileSource>& files) {
    Silent silent;
    const LibraryPath library({folder.path("lib"), folder.path()}, files);
    const std::vector<std::string> names{"room.rad"};
    const auto model = read_scene(names, {library, true, folder.path()}, silent);
    FileResources resources(library, true, silent);
    std::string text = resources.function_file("paint.cal");
    text += std::to_string(resources.data("table.dat")->values.at(1));
    text += library.find("none.cal").value_or("-");
    for (const Primitive& primitive : test::all_primitives(*model)) {
        text += ' ' + primitive.name;
        for (const double real : primitive.reals) text += ' ' + std::to_string(real);
    }
    return text;
}

}  // namespace

TEST_CASE("a scene is read from a recording as it was read from its files") {
    const TemporaryFolder folder;
    write_scene(folder);
    const auto recorder = std::make_shared<FileRecorder>(real_files(), true);
    const std::string expected = read_all(folder, recorder);
    CHECK(expected.find(" ball") != std::string::npos);
    CHECK(expected.find(" c ") != std::string::npos);  // which a shell has written
    const auto replay = std::make_shared<FileReplay>(recorder->take());
    std::filesystem::remove_all(folder.path("lib"));
    for (const char* name : {"room.rad", "one.part", "two.part", "points"})
        std::filesystem::remove(folder.path(name));
    CHECK(read_all(folder, replay) == expected);
    CHECK_THROWS_WITH_AS((void)replay->read("other.rad"),
                         "other.rad: not among the files that rank 0 has read", InputError);
    replay->clear();
    CHECK_THROWS_AS((void)read_all(folder, replay), InputError);
}

TEST_CASE("errors, missing files, places and views are recorded, too") {
    const TemporaryFolder folder;
    const std::string view = folder.write("a.vf", "VIEW= -vp 1 2 3\n\nrest");
    FileRecorder recorder(real_files(), true);
    const std::string missing = folder.path("none"), here = folder.path();
    std::string message;
    try {
        (void)recorder.read(missing);
    } catch (const InputError& error) {
        message = error.what();
    }
    CHECK(message.find("cannot open") != std::string::npos);
    CHECK_FALSE(recorder.readable(missing));
    CHECK(recorder.readable(view));
    CHECK_FALSE(recorder.place("$LIGHTWALK_NO_SUCH_VARIABLE"));
    const auto path = recorder.place("$PATH");
    CHECK(recorder.answer(Question::beginning, view, 1000) == "VIEW= -vp 1 2 3\n\n");
    FileReplay replay(recorder.take());
    CHECK_THROWS_WITH_AS((void)replay.read(missing), message.c_str(), InputError);
    CHECK_FALSE(replay.readable(missing));
    CHECK(replay.readable(view));
    CHECK_FALSE(replay.place("$LIGHTWALK_NO_SUCH_VARIABLE"));
    CHECK(replay.place("$PATH") == path);
    View seen;
    const std::vector<std::string> words{"-vf", view};
    CHECK(parse_view_option(words, seen, replay) == 2);
    CHECK(seen.position == Vec3{1, 2, 3});
}

TEST_CASE("digests name the files that were read, without folders, and change with their bytes") {
    const TemporaryFolder one, two;
    const auto digests = [](const TemporaryFolder& folder) {
        const auto recorder = std::make_shared<FileRecorder>();
        (void)read_all(folder, recorder);
        CHECK(recorder->take().empty());
        return recorder->digests();
    };
    write_scene(one);
    write_scene(two);
    const std::vector<std::string> before = digests(one);
    REQUIRE(before.size() >= 7);
    CHECK(before[0].starts_with("room.rad "));
    CHECK(before.back().starts_with("table.dat "));
    // The command of the shell names its folder.
    const auto differing = [&] {
        std::vector<std::string> names;
        const std::vector<std::string> now = digests(two);
        REQUIRE(now.size() == before.size());
        for (std::size_t i = 0; i < now.size(); ++i) {
            if (now[i] != before[i]) names.push_back(now[i].substr(0, now[i].find(' ')));
        }
        return names;
    };
    CHECK(differing().empty());
    two.write("lib/paint.cal", "paint = .6;");
    CHECK(differing() == std::vector<std::string>{"paint.cal"});
}

TEST_CASE("bytes that are no recording are refused, whatever they are") {
    const TemporaryFolder folder;
    FileRecorder recorder(real_files(), true);
    (void)recorder.read(folder.write("a", "some bytes"));
    (void)recorder.readable(folder.path("b"));
    const std::string sound = recorder.take();
    (void)FileReplay(sound);
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string bytes = sound.substr(0, random() % (sound.size() + 1));
        if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<char>(random());
        try {
            FileReplay replay(bytes);
            (void)replay.readable(folder.path("b"));
        } catch (const InputError&) {
        }
    }
    CHECK_THROWS_AS((void)FileReplay("x"), InputError);
}
