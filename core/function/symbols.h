#pragma once
// Names of the function language: contexts, qualified names, definitions.
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/function/environment.h"
#include "core/function/expression.h"
#include "core/function/library.h"

namespace lightwalk::function {

struct Definition {
    bool is_function = false;
    bool constant = false;  ///< made with ':'
    std::vector<std::string> parameters;
    Expr body;
};

struct Symbol {
    std::string name;                       ///< qualified
    const LibraryEntry* library = nullptr;  ///< the built-in function of that name
    std::optional<Definition> definition;

    [[nodiscard]] bool is_user_function() const { return definition && definition->is_function; }
    [[nodiscard]] bool is_variable() const { return definition && !definition->is_function; }
    [[nodiscard]] bool is_function() const { return is_user_function() || library; }
    /// Whether a call with constant arguments may be replaced by its value.
    [[nodiscard]] bool is_constant_function() const {
        return definition ? definition->is_function && definition->constant
                          : library && library->constant();
    }
};

/// All names of a scene. A context is a string of components that each begin with a backquote, or
/// "". A name x in context C is first x + C, then x with the components of C removed from the front
/// one by one; `x is only the first of these and x` only the last.
class SymbolTable {
  public:
    /// A table that contains the built-in functions.
    explicit SymbolTable(FunctionEnvironment::Library library);

    [[nodiscard]] const Symbol& operator[](SymbolId id) const { return symbols_[id]; }

    /// The symbol that `name` refers to in `context`; nothing when there is none yet.
    [[nodiscard]] std::optional<SymbolId> find(std::string_view name,
                                               std::string_view context) const;
    /// The symbol that `name` refers to in `context`; it is created where there is none: globally
    /// for library functions, else locally.
    SymbolId refer(std::string_view name, std::string_view context);
    /// Create or replace the definition of `name` at `context` itself.
    void define(std::string_view name, std::string_view context, Definition definition);

    [[nodiscard]] FunctionEnvironment::Library library() const { return library_; }

  private:
    SymbolId entry(const std::string& qualified);

    FunctionEnvironment::Library library_;
    std::vector<Symbol> symbols_;
    std::unordered_map<std::string, SymbolId> ids_;
};

/// The context of function file `file`: a backquote, then its name without ".cal" and with every
/// character that no name may have replaced by '_'; "" for ".".
[[nodiscard]] std::string context_of_file(std::string_view file);

/// Character classes of names, independent of the locale.
[[nodiscard]] inline bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
[[nodiscard]] inline bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
[[nodiscard]] inline bool is_name_character(char c) {
    return is_letter(c) || is_digit(c) || c == '_' || c == '.' || c == '`';
}

}  // namespace lightwalk::function
