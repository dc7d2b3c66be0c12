#pragma once
// One primitive as scene text: read without resolving names, and written back.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/model/primitive.h"
#include "io/language/tokenizer.h"

namespace lightwalk {

/// A primitive with its names as they stand in the text.
struct PrimitiveText {
    std::string modifier;
    std::string type_word;
    PrimitiveType type{};
    std::string name;
    std::vector<std::string> strings;  ///< an alias: its one reference
    std::vector<double> reals;
    SourceLocation where;
};

/// The first three words, MODIFIER TYPE IDENTIFIER, as far as the text goes; `type` is not set yet.
/// `primitive` may be one that was read before: its memory is used again, its arguments are
/// forgotten.
void read_primitive_head(SceneTokenizer& tokens, PrimitiveText& primitive);

/// Set `type` from its word. Throws InputError "unknown type ...".
void resolve_type(PrimitiveText& primitive);

/// Read the counts and arguments that follow the head (an alias: its reference). Throws InputError
/// "bad arguments for TYPE "NAME": ..." when they are not what the counts promise.
void read_primitive_arguments(SceneTokenizer& tokens, PrimitiveText& primitive);

/// All of the above, for readers that do not look names up.
[[nodiscard]] PrimitiveText read_primitive(SceneTokenizer& tokens);

/// How `write_primitive` rounds numbers: significant decimal digits.
inline constexpr int kFullDigits = 12;

/// Append a word, in quotes where it must be.
void append_word(std::string_view word, std::string& out);

/// Append the primitive as scene text, numbers with `digits` significant digits, words quoted where
/// they must be. Throws InputError for a number that is not finite.
void write_primitive(const PrimitiveText& primitive, int digits, std::string& out);

}  // namespace lightwalk
