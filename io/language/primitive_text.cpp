#include "io/language/primitive_text.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/model/model_builder.h"
#include "core/model/transform_args.h"
#include "io/language/number_text.h"

namespace lightwalk {
namespace {

/// The next word, or an empty one at the end of the text.
std::string_view next_word(SceneTokenizer& tokens) {
    return tokens.word().value_or(std::string_view());
}

[[noreturn]] void bad_arguments(const PrimitiveText& primitive, const std::string& expected,
                                const std::optional<std::string_view>& found) {
    throw InputError(primitive.where,
                     "bad arguments for " + primitive.type_word + " \"" + primitive.name +
                         "\": expected " + expected + ", found " +
                         (found ? "\"" + std::string(*found) + "\"" : "the end of the text"));
}

/// A count of `what`, at most `most`.
std::size_t read_count(SceneTokenizer& tokens, const PrimitiveText& primitive, const char* what,
                       long most = std::numeric_limits<long>::max()) {
    const std::optional<std::string_view> word = tokens.word();
    long count = 0;
    if (!word || !parse_integer(*word, count) || count < 0 || count > most) {
        bad_arguments(primitive, what, word);
    }
    return static_cast<std::size_t>(count);
}

/// How many words can follow at most, whatever a count says: each takes a character and a blank.
std::size_t most_words(const SceneTokenizer& tokens) {
    return tokens.left() / 2 + 1;
}

void read_strings(SceneTokenizer& tokens, PrimitiveText& primitive) {
    const std::size_t count = read_count(tokens, primitive, "the number of strings");
    for (std::size_t left = count; left > 0; --left) {
        const std::optional<std::string_view> word = tokens.word();
        if (!word) bad_arguments(primitive, std::to_string(left) + " more strings", word);
        primitive.strings.emplace_back(*word);
    }
}

void read_reals(SceneTokenizer& tokens, PrimitiveText& primitive) {
    const std::size_t count = read_count(tokens, primitive, "the number of numbers");
    primitive.reals.reserve(std::min(count, most_words(tokens)));
    for (std::size_t left = count; left > 0; --left) {
        double value = 0;
        if (!tokens.simple_real(value)) {
            const std::optional<std::string_view> word = tokens.word();
            if (!word || !parse_real(*word, value)) {
                bad_arguments(primitive, std::to_string(left) + " more numbers", word);
            }
        }
        primitive.reals.push_back(value);
    }
}

/// Whether a word needs no quotes to be read back.
bool is_plain(std::string_view word) {
    return !word.empty() && std::ranges::none_of(word, [](char c) {
        return c == ' ' || (c >= '\t' && c <= '\r') || c == '"' || c == '\'';
    });
}

}  // namespace

void read_primitive_head(SceneTokenizer& tokens, PrimitiveText& primitive) {
    static_cast<void>(tokens.peek());  // white space: the location is the primitive's then
    primitive.where = tokens.where();
    primitive.modifier = next_word(tokens);
    primitive.type_word = next_word(tokens);
    primitive.name = next_word(tokens);
    primitive.strings.clear();
    primitive.reals.clear();
}

void resolve_type(PrimitiveText& primitive) {
    const std::optional<PrimitiveType> type = primitive_type(primitive.type_word);
    if (type) {
        primitive.type = *type;
        return;
    }
    std::vector<std::string_view> known;
    for (int i = 0; i <= static_cast<int>(PrimitiveType::alias); ++i) {
        known.push_back(to_string(static_cast<PrimitiveType>(i)));
    }
    throw InputError(primitive.where, "unknown type \"" + primitive.type_word + "\"" +
                                          did_you_mean(primitive.type_word, known));
}

void read_primitive_arguments(SceneTokenizer& tokens, PrimitiveText& primitive) {
    if (primitive.type == PrimitiveType::alias) {
        const std::optional<std::string_view> target = tokens.word();
        if (!target) bad_arguments(primitive, "the modifier it stands for", target);
        primitive.strings.emplace_back(*target);
        return;
    }
    read_strings(tokens, primitive);
    read_count(tokens, primitive, "0 integers", 0);
    read_reals(tokens, primitive);
}

PrimitiveText read_primitive(SceneTokenizer& tokens) {
    PrimitiveText primitive;
    read_primitive_head(tokens, primitive);
    resolve_type(primitive);
    read_primitive_arguments(tokens, primitive);
    return primitive;
}

/// The language knows no escapes: each quote goes into the other kind.
void append_word(std::string_view word, std::string& out) {
    if (is_plain(word)) {
        out += word;
        return;
    }
    if (word.empty()) out += "\"\"";
    for (std::size_t at = 0; at < word.size();) {
        const char quote = word[at] == '"' ? '\'' : '"';
        const std::size_t end = std::min(word.find(quote, at), word.size());
        out.push_back(quote);
        out += word.substr(at, end - at);
        out.push_back(quote);
        at = end;
    }
}

void write_primitive(const PrimitiveText& primitive, int digits, std::string& out) {
    out.push_back('\n');
    append_word(primitive.modifier, out);
    out.push_back(' ');
    out += primitive.type_word;
    out.push_back(' ');
    append_word(primitive.name, out);
    if (primitive.type == PrimitiveType::alias) {
        out.push_back(' ');
        if (!primitive.strings.empty()) append_word(primitive.strings[0], out);
        out.push_back('\n');
        return;
    }
    out += "\n" + std::to_string(primitive.strings.size());
    for (const std::string& word : primitive.strings) {
        out.push_back(' ');
        append_word(word, out);
    }
    out += "\n0\n" + std::to_string(primitive.reals.size());
    for (std::size_t i = 0; i < primitive.reals.size(); ++i) {
        out.push_back(i % 3 == 0 && primitive.reals.size() > 4 ? '\n' : ' ');
        append_real(primitive.reals[i], digits, out);
    }
    out.push_back('\n');
}

void append_primitive(std::string_view modifier, std::string_view type, const std::string& name,
                      const std::vector<std::string>& strings, const std::vector<double>& reals,
                      int digits, std::string& out) {
    PrimitiveText text;
    text.modifier = modifier;
    text.type_word = type;
    text.name = name;
    text.strings = strings;
    text.reals = reals;
    write_primitive(text, digits, out);
}

}  // namespace lightwalk
