#include "io/language/tokenizer.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace lightwalk {
namespace {

using Item = SceneTokenizer::Item;

std::vector<std::string> words(const std::string& text) {
    SceneTokenizer tokens(text, "t.rad");
    std::vector<std::string> result;
    while (const std::optional<std::string_view> word = tokens.word()) result.emplace_back(*word);
    return result;
}

TEST_CASE("words end at white space outside quotes, and quotes vanish") {
    using Tokens = std::vector<std::string>;
    CHECK(words("a b\tc\nd\re\vf\fg") == Tokens{"a", "b", "c", "d", "e", "f", "g"});
    CHECK(words("a\"b c\"d") == Tokens{"ab cd"});
    CHECK(words("'say \"hi\"' \"it's\"") == Tokens{"say \"hi\"", "it's"});
    CHECK(words("\"\" x") == Tokens{"", "x"});
    CHECK(words("a#b !c") == Tokens{"a#b", "!c"});
    CHECK(words("x 'open to the end\n y") == Tokens{"x", "open to the end\n y"});
    CHECK(words("a\\ b") == Tokens{"a\\", "b"});  // no escapes
    CHECK(words(" \n ").empty());
}

TEST_CASE("# and ! begin an item wherever an item may begin") {
    SceneTokenizer tokens("  # note !x\n word# !cmd a\n", "t.rad");
    CHECK(tokens.peek() == Item::comment);
    CHECK(tokens.comment() == "# note !x");
    CHECK(tokens.peek() == Item::primitive);
    CHECK(tokens.word() == "word#");
    CHECK(tokens.peek() == Item::command);
    CHECK(tokens.command() == "!cmd a");
    CHECK(tokens.peek() == Item::end);
    CHECK_FALSE(tokens.word());
}

TEST_CASE("a command ends at LF, CR LF or CR, a backslash before it keeps it and joins the lines") {
    const auto command = [](const std::string& text) {
        return SceneTokenizer(text, "t").command();
    };
    CHECK(command("!a b\nc") == "!a b");
    CHECK(command("!a b\r\nc") == "!a b");
    CHECK(command("!a b\rc") == "!a b");
    CHECK(command("!a b") == "!a b");
    CHECK(command("!a \\\n b\nc") == "!a \\\n b");
    CHECK(command("!a \\\r\n b\nc") == "!a \\\r\n b");
    CHECK(command("!\\\n") == "!\\\n");
    const std::string longer = "!" + std::string(100000, 'x');  // Radiance stops at 2047
    CHECK(command(longer + "\n") == longer);
}

TEST_CASE("lines are counted whichever way they end, in words, comments and commands") {
    SceneTokenizer tokens("a\nb\r\nc\rd # x\n!cmd \\\n more\nlast", "room.rad");
    const auto line_at = [&] {
        static_cast<void>(tokens.peek());
        return tokens.where().line;
    };
    CHECK(line_at() == 1);
    CHECK(tokens.word() == "a");
    CHECK(line_at() == 2);
    CHECK(tokens.word() == "b");
    CHECK(line_at() == 3);
    CHECK(tokens.word() == "c");
    CHECK(line_at() == 4);
    CHECK(tokens.word() == "d");
    CHECK(tokens.peek() == Item::comment);
    tokens.comment();
    CHECK(line_at() == 5);
    CHECK(tokens.command() == "!cmd \\\n more");
    CHECK(line_at() == 7);
    CHECK(tokens.where().file == "room.rad");
}

TEST_CASE("a word without quotes lies in the text") {
    const std::string text = "  plain \"quoted\" last";
    SceneTokenizer tokens(text, "t.rad");
    CHECK(tokens.word().value().data() == text.data() + 2);
    CHECK(tokens.word() == "quoted");
    CHECK(tokens.word().value().data() == text.data() + text.size() - 4);
    CHECK(tokens.left() == 0);
    CHECK(tokens.offset() == text.size());
}

TEST_CASE("a piece of a text counts its lines on") {
    SceneTokenizer tokens("\na\n\n", "t.rad", 41);
    CHECK(tokens.peek() == Item::primitive);
    CHECK(tokens.where().line == 42);
    CHECK(tokens.word() == "a");
    CHECK(tokens.peek() == Item::end);
    CHECK(tokens.where().line == 44);
}

TEST_CASE("lines within quotes count, before the next word and not before") {
    SceneTokenizer tokens("'a\r\nb\rc\n' d", "t.rad");
    CHECK(tokens.word() == "a\r\nb\rc\n");
    CHECK(tokens.where().line == 4);
    CHECK(tokens.word() == "d");
    CHECK(tokens.where().line == 4);
}

TEST_CASE("a simple number is a whole word, any other word stays to be read") {
    SceneTokenizer tokens("1\n-2.5e1\t3x 4\"\" 5", "t.rad");
    double value = 0;
    CHECK(tokens.simple_real(value));
    CHECK(value == 1);
    CHECK(tokens.simple_real(value));
    CHECK(value == -25);
    CHECK(tokens.where().line == 2);
    CHECK_FALSE(tokens.simple_real(value));
    CHECK(tokens.word() == "3x");
    CHECK_FALSE(tokens.simple_real(value));
    CHECK(tokens.word() == "4");
    CHECK(tokens.simple_real(value));
    CHECK(value == 5);
    CHECK_FALSE(tokens.simple_real(value));
    CHECK_FALSE(tokens.word());
}

TEST_CASE("a word of more than 64 KiB is refused") {
    const std::string limit(65536, 'x');
    CHECK(words(limit) == std::vector<std::string>{limit});
    CHECK_THROWS_WITH_AS(words("\n" + limit + "x"), "t.rad:2: word longer than 64 KiB", InputError);
}

}  // namespace
}  // namespace lightwalk
