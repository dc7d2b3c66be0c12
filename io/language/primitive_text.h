#pragma once
// A primitive as scene text, read without resolving names, and written.
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
    std::vector<std::string> strings;  ///< for an alias the name that it refers to
    std::vector<double> reals;
    SourceLocation where;
};

/// Read the first three words, MODIFIER TYPE IDENTIFIER; words beyond the end of the text are
/// empty. `type` is not set. `primitive` may hold an earlier primitive: its memory is reused, its
/// arguments are removed.
void read_primitive_head(SceneTokenizer& tokens, PrimitiveText& primitive);

/// Set `type` from `type_word`. Throws InputError "unknown type ...".
void resolve_type(PrimitiveText& primitive);

/// Read the counts and arguments that follow the head, or the reference of an alias. Throws
/// InputError "bad arguments for TYPE "NAME": ..." when the arguments do not agree with the counts.
void read_primitive_arguments(SceneTokenizer& tokens, PrimitiveText& primitive);

/// Read a whole primitive: its head, its type and its arguments.
[[nodiscard]] PrimitiveText read_primitive(SceneTokenizer& tokens);

/// Significant decimal digits that `write_primitive` is usually called with.
inline constexpr int kFullDigits = 12;

/// Append a word, in quotes where the scene language needs them.
void append_word(std::string_view word, std::string& out);

/// Append a primitive as scene text; numbers have `digits` significant digits. Throws InputError
/// for a number that is not finite.
void write_primitive(const PrimitiveText& primitive, int digits, std::string& out);
void append_primitive(std::string_view modifier, std::string_view type, const std::string& name,
                      const std::vector<std::string>& strings, const std::vector<double>& reals,
                      int digits, std::string& out);

}  // namespace lightwalk
