#include "io/options/option_words.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace lightwalk;

namespace {

/// A file in a folder of its own, gone with the object.
class TemporaryFile {
  public:
    TemporaryFile(const std::string& name, const std::string& text) {
        std::filesystem::create_directories(folder());
        path_ = folder() / name;
        std::ofstream(path_) << text;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    [[nodiscard]] std::string path() const { return path_.string(); }
    static std::filesystem::path folder() {
        return std::filesystem::temp_directory_path() / "lightwalk-option-words";
    }

  private:
    std::filesystem::path path_;
};

std::vector<std::string> all(std::vector<std::string> line) {
    OptionWords words(std::move(line));
    std::vector<std::string> seen;
    while (words.at_option()) {
        seen.push_back(words.option());
        words.skip(1);
    }
    return seen;
}

std::string usage_error(const std::vector<std::string>& line) {
    try {
        OptionWords words(line);
        (void)words.at_option();
        (void)words.integer();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("@file stands for its words, without quotes or comments, also within files") {
    const TemporaryFile inner("inner", " -ab\n1 #\t\"x y\" ");
    const TemporaryFile outer("outer", "-x 3 @" + inner.path() + " -y");
    CHECK(all({"@" + outer.path(), "scene"}) ==
          std::vector<std::string>{"-x", "3", "-ab", "1", "#", "\"x", "y\"", "-y", "scene"});
    const TemporaryFile empty("empty", " \n");
    CHECK(all({"-a", "@" + empty.path(), "-b"}) == std::vector<std::string>{"-a", "-b"});
}

TEST_CASE("only words in option position are expanded") {
    OptionWords words({"-vf", "@none"});
    REQUIRE(words.at_option());
    CHECK(words.text() == "@none");
    CHECK_FALSE(words.at_option());
}

TEST_CASE("$NAME stands for the words of the environment variable") {
    REQUIRE(setenv("LIGHTWALK_TEST_WORDS", "-u+ -lr 4", 1) == 0);
    CHECK(all({"$LIGHTWALK_TEST_WORDS", "s"}) == std::vector<std::string>{"-u+", "-lr", "4", "s"});
    CHECK(all({"$", "@"}) == std::vector<std::string>{"$", "@"});
}

TEST_CASE("a missing file or variable, and a file that includes itself, are usage errors") {
    CHECK(usage_error({"@/none/such"}).starts_with("cannot expand '@/none/such': "));
    CHECK(usage_error({"$LIGHTWALK_NO_SUCH"}) ==
          "cannot expand '$LIGHTWALK_NO_SUCH': no such environment variable");
    const std::string path = (TemporaryFile::folder() / "self").string();
    const TemporaryFile self("self", "-x @" + path);
    CHECK_THROWS_WITH_AS((void)all({"@" + path}),
                         ("cannot expand '@" + path + "': it includes itself").c_str(), UsageError);
    const TemporaryFile twice("twice", "-a -b");  // the same file one after the other is no circle
    CHECK(all({"@" + twice.path(), "@" + twice.path()}).size() == 4);
}

TEST_CASE("files that multiply end in an error, not in exhausted memory") {
    std::string many;
    const std::string last = (TemporaryFile::folder() / "d").string();
    for (int i = 0; i < 4000; ++i) many += "@" + last + " ";
    std::string words;
    for (int i = 0; i < 4000; ++i) words += "w ";
    const TemporaryFile d("d", words);
    const TemporaryFile c("c", many);
    CHECK_THROWS_AS((void)all({"@" + c.path()}), UsageError);
    const TemporaryFile big("big", words + words);
    CHECK_THROWS_AS((void)all({"@" + big.path()}), UsageError);
}

TEST_CASE("numbers are strict: message with option, what was found, what was expected") {
    CHECK(usage_error({"-x", "3.5"}) == "option -x: expected an integer, found \"3.5\"");
    CHECK(usage_error({"-x"}) == "option -x: expected an integer, found nothing");
    CHECK(usage_error({"-x", "99999999999"}) ==
          "option -x: expected an integer, found \"99999999999\"");
    CHECK(usage_error({"-x", "-4"}).empty());
    OptionWords words({"-av", ".1", "2e0", "nan"});
    REQUIRE(words.at_option());
    CHECK_THROWS_WITH_AS((void)words.rgb(), "option -av: expected a number, found \"nan\"",
                         UsageError);
    OptionWords seed({"--seed", "18446744073709551615", "--seed", "18446744073709551616"});
    REQUIRE(seed.at_option());
    CHECK(seed.unsigned_integer() == UINT64_MAX);
    REQUIRE(seed.at_option());
    CHECK_THROWS_AS((void)seed.unsigned_integer(), UsageError);
}

TEST_CASE("a bare switch toggles, + 1 - 0 attached set it, anything else is another option") {
    const auto toggled = [](const std::string& word, bool current) {
        OptionWords words({word});
        REQUIRE(words.at_option());
        return words.toggle("-dv", current);
    };
    CHECK(toggled("-dv", true) == false);
    CHECK(toggled("-dv", false) == true);
    for (const bool current : {false, true}) {
        CHECK(toggled("-dv+", current) == true);
        CHECK(toggled("-dv1", current) == true);
        CHECK(toggled("-dv-", current) == false);
        CHECK(toggled("-dv0", current) == false);
        for (const std::string word : {"-dvy", "-dv++", "-d", "-dt"})
            CHECK_FALSE(toggled(word, current).has_value());
    }
}

TEST_CASE("the nearest name is one edit away, two for long words") {
    const std::vector<std::string> names{"-av", "-ab", "--stats", "render"};
    CHECK(nearest_name("--stat", names) == "--stats");
    CHECK(nearest_name("rednre", names) == "render");
    CHECK(nearest_name("-aw", names) == "-av");
    CHECK(nearest_name("-va", names) == "-av");
    CHECK_FALSE(nearest_name("-pq", names).has_value());
    CHECK_FALSE(nearest_name("picture", names).has_value());
    CHECK_FALSE(nearest_name(std::string(100000, 'x'), names).has_value());
}

TEST_CASE("history lines quote words that are empty or hold blanks or inner quotes") {
    const std::vector<std::string> words{"rpict", "a b", "", "x\"y", "x'y", "'x'", "line\nend"};
    CHECK(history_line(words) == "rpict \"a b\" \"\" 'x\"y' \"x'y\" 'x' \"line end\"");
}
