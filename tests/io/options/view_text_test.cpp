#include "io/options/view_text.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/shared_data.h"

using namespace lightwalk;

namespace {

using Words = std::vector<std::string>;

/// Applies all words as options.
View parsed_view(const Words& words, View view = {}) {
    for (std::size_t i = 0; i < words.size();) {
        const std::size_t used = parse_view_option(std::span(words).subspan(i), view);
        REQUIRE(used > 0);
        i += used;
    }
    return view;
}

View from_file(const std::string& text, View view = {}) {
    read_view_file(text, "t.vf", view);
    return view;
}

}  // namespace

TEST_CASE("view options set what they name and nothing else") {
    const View view = parsed_view({"-vtl", "-vp", "1",   "2.5", "-3e1", "-vh", "4",   "-vv",  "2",
                                   "-vo",  ".5",  "-va", "9",   "-vs",  "0.1", "-vl", "-0.2", "-vd",
                                   "0",    "0",   "-1",  "-vu", "0",    "1",   "0"});
    CHECK(view == View{'l', {1, 2.5, -30}, {0, 0, -1}, {0, 1, 0}, 4, 2, 0.5, 9, 0.1, -0.2});
    View changed = view;
    changed.horizontal = 60;
    CHECK(parsed_view({"-vh", "60"}, view) == changed);
}

TEST_CASE("other options are not view options") {
    View view;
    for (const std::string word : {"-x", "-vpx", "-v", "-version", "-vx", "vp", "-vfx", ""}) {
        CAPTURE(word);
        const Words words{word, "1", "2", "3"};
        CHECK(parse_view_option(words, view) == 0);
    }
    CHECK(parse_view_option({}, view) == 0);
    CHECK(view == View{});
}

TEST_CASE("malformed view options say what was expected and change nothing") {
    const auto check_error = [](const Words& words, const char* message) {
        View view;
        CHECK_THROWS_WITH_AS(parse_view_option(words, view), doctest::Contains(message),
                             InputError);
        CHECK(view == View{});
    };
    check_error({"-vp", "1", "2"}, "option -vp 1 2: expected three numbers");
    check_error({"-vp", "1", "2", "x"}, "option -vp 1 2 x: expected three numbers");
    check_error({"-vh"}, "option -vh: expected a number");
    check_error({"-vh", "nan"}, "option -vh nan: expected a number");
    check_error({"-vt", "v"}, "option -vt: expected one of the letters");
    check_error({"-vf"}, "option -vf: expected the name of a view file");
    check_error({"-vf", "/no/such.vf"}, "/no/such.vf: cannot open view file");
    check_error({"-vf", "/"}, "/: bad view file");
}

TEST_CASE("a view that was written reads back") {
    View view{
        'a', {1.234567, -20, 3e5}, {0.1234567, -0.5, 2}, {0.5, 0, 1}, 123.45, 60, 0.25, 100, -0.5,
        1};
    const std::string text = view_text(view);
    CHECK(text ==
          "-vta -vp 1.234567 -20 300000 -vd 0.1234567 -0.5 2 -vu 0.5 0 1 -vh 123.45 -vv 60 "
          "-vo 0.25 -va 100 -vs -0.5 -vl 1");
    View back;
    CHECK(parse_view_string(text, back) == 10);
    CHECK(back == view);
}

TEST_CASE("a view string skips what it does not know, word by word") {
    View view;
    CHECK(parse_view_string(" a -b -vf file -vp 1 2 -vh 30 -vp 1 2 3 -x 470 -vv", view) == 2);
    View expected;
    expected.position = {1, 2, 3};
    expected.horizontal = 30;
    CHECK(view == expected);
    CHECK(parse_view_string("", view) == 0);
}

TEST_CASE("view lines begin with VIEW= or a program's name, at the first column") {
    const auto type = [](const std::string& line) {
        return from_file("VIEW= -vtc\n" + line + " -vta -vh 20\n").type;
    };
    for (const std::string word : {"VIEW=", "VIEW=more", "rpict", "rview", "rvu", "/usr/bin/rvu",
                                   "../rpiece", "rxpiece", "pinterp", "lightwalk", "rpict.exe"}) {
        CAPTURE(word);
        CHECK(type(word) == 'a');
    }
    for (const std::string word :
         {" VIEW=", "\tVIEW=", "VIEW", "view=", "oconv", "xrpict", "rpict/", "#VIEW="}) {
        CAPTURE(word);
        CHECK(type(word) == 'c');
    }
}

TEST_CASE("later view lines win parameter by parameter, up to the first empty line") {
    const View view =
        from_file("#?RADIANCE\r\nrpict -vp 1 2 3 -vh 30 a.oct\r\nrvu -vh 40\r\n\r\nrvu -vh 50\r\n");
    CHECK(view.position == Vec3{1, 2, 3});
    CHECK(view.horizontal == 40);
    View current;
    current.vertical = 11;
    CHECK(from_file("VIEW= -vh 20", current).vertical == 11);
}

TEST_CASE("files without a view are bad view files") {
    for (const std::string text : {"", "\n", "\nVIEW= -vh 20\n", "hello\n", "VIEW=\n",
                                   "rvu -x 200\n", "\x01VIEW= -vh 20\n"}) {
        CAPTURE(text);
        CHECK_THROWS_WITH_AS((void)from_file(text), doctest::Contains("t.vf: bad view file"),
                             InputError);
    }
}

TEST_CASE("-vf applies a file to the current view, and later options change it") {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        ("lightwalk-view-" + std::to_string(std::hash<std::string>{}(__FILE__)));
    std::ofstream(path) << "VIEW= -vtl -vp 1 2 3\n\nVIEW= -vp 7 7 7\n";
    const View view = parsed_view({"-vh", "33", "-vf", path.string(), "-vtv"});
    std::filesystem::remove(path);
    CHECK(view.position == Vec3{1, 2, 3});
    CHECK(view.horizontal == 33);
    CHECK(view.type == 'v');
}

TEST_CASE("in a sequence every view line is a frame that starts from the one before") {
    const std::vector<View> frames = read_view_sequence(
        "path\nVIEW= -vp 1 0 0\n\nVIEW= -vh 30\nVIEW= nothing\nrvu -vp 2 0 0", {});
    REQUIRE(frames.size() == 3);
    CHECK(frames[0].position == Vec3{1, 0, 0});
    CHECK(frames[1].position == Vec3{1, 0, 0});
    CHECK(frames[1].horizontal == 30);
    CHECK(frames[2].position == Vec3{2, 0, 0});
    CHECK(frames[2].horizontal == 30);
}

TEST_CASE("the sample models' view files and a picture's view are legal views") {
    LIGHTWALK_NEEDS_SHARED(folder, "scenes/cabin/vf");
    int views = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        CAPTURE(entry.path().string());
        const View view = parsed_view({"-vf", entry.path().string()});
        CHECK_FALSE(Camera::problem(view));
        ++views;
    }
    CHECK(views >= 20);
    LIGHTWALK_NEEDS_SHARED(picture, "reference/pictures/summer-bath.hdr");
    const View view = parsed_view({"-vf", picture});
    CHECK(view_text(view) ==
          "-vtv -vp 8 14.5 5 -vd -0.868092 0.4275 -0.252309 -vu 0 0 1 -vh 45 -vv 60 "
          "-vo 0 -va 0 -vs 0 -vl 0");
}
