#include "io/language/primitive_text.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace lightwalk {
namespace {

/// The primitive as far as it can be read.
PrimitiveText read_some(const std::string& text, std::string& error) {
    SceneTokenizer tokens(text, "t.rad");
    PrimitiveText primitive;
    try {
        read_primitive_head(tokens, primitive);
        resolve_type(primitive);
        read_primitive_arguments(tokens, primitive);
    } catch (const InputError& caught) {
        error = caught.what();
    }
    return primitive;
}

TEST_CASE("a count reserves no more than the text can hold") {
    std::string error;
    const PrimitiveText few = read_some("void plastic m 0 0 1000000000000000 1 2 3", error);
    CHECK(few.reals == std::vector<double>{1, 2, 3});
    CHECK(few.reals.capacity() < 100);
    CHECK(error ==
          "t.rad:1: bad arguments for plastic \"m\": expected 999999999999997 more numbers, found "
          "the end of the text");
    const PrimitiveText words = read_some("void plastic m 9223372036854775807 a b", error);
    CHECK(words.strings.size() == 2);
    CHECK(words.strings.capacity() < 100);
    CHECK(error.find("expected 9223372036854775805 more strings") != std::string::npos);
    CHECK(read_some("void plastic m 9223372036854775808 a", error).strings.empty());
    CHECK(error.find("expected the number of strings, found") != std::string::npos);
}

TEST_CASE("numbers take exactly the memory of their count") {
    std::string error;
    CHECK(read_some("void polygon p 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0 x", error).reals.capacity() ==
          12);
}

TEST_CASE("numbers of every form, quoted ones too, are read as parse_real reads words") {
    std::string error;
    const PrimitiveText many = read_some(
        "void plastic m 0 0 8 +1 '2' \"-\"3 4.e0 .5 6e-400 0.1234567890123456789 8", error);
    CHECK(error == "");
    CHECK(many.reals == std::vector<double>{1, 2, -3, 4, .5, 0, 0.1234567890123456789, 8});
    for (const char* bad : {"1,", "1x", "0x1", "1e999", "nan", "--1", "''", "1\"x\"", "1e+"}) {
        CAPTURE(bad);
        error.clear();
        static_cast<void>(read_some("void plastic m 0 0 1 " + std::string(bad) + " 7", error));
        CHECK(error.find("expected 1 more numbers, found") != std::string::npos);
    }
}

TEST_CASE("a primitive's memory is used again, and nothing of it left") {
    const std::string text = "void texfunc t 2 a b 0 1 5 void plastic p 0 0 0";
    SceneTokenizer tokens(text, "t.rad");
    PrimitiveText primitive;
    for (const char* name : {"t", "p"}) {
        read_primitive_head(tokens, primitive);
        resolve_type(primitive);
        read_primitive_arguments(tokens, primitive);
        CHECK(primitive.name == name);
    }
    CHECK(primitive.strings.empty());
    CHECK(primitive.reals.empty());
}

TEST_CASE("written words are read back as they were, whatever quotes they hold") {
    for (const char* word : {"", "plain", "two words", "it's", "\"both' \"", "a\tb", "#x"}) {
        CAPTURE(word);
        std::string text;
        append_word(word, text);
        SceneTokenizer tokens(text, "t");
        CHECK(tokens.word() == word);
        CHECK_FALSE(tokens.word());
    }
}

}  // namespace
}  // namespace lightwalk
