#pragma once
// Files of rad(1): variables that say what is to be rendered of a scene, from where, and how well.
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"

namespace lightwalk {

/// What a variable of a rad file says.
struct RadValue {
    std::string text;
    SourceLocation where;
};

/// The variables of a rad file. Their names may be cut short. Source: Radiance manual page rad(1).
class RadFile {
  public:
    explicit RadFile(std::string name) : name_(std::move(name)) {}

    [[nodiscard]] const std::string& name() const { return name_; }
    /// The values of a variable, which has its full name here, in the order of their assignments.
    [[nodiscard]] std::vector<RadValue> values(std::string_view variable) const;
    /// The value of a variable that has but one: the last; null: none was assigned.
    [[nodiscard]] const RadValue* value(std::string_view variable) const;

    /// Take "NAME= value". An empty value says nothing. Throws InputError for an unknown variable.
    void assign(std::string_view assignment, const SourceLocation& where);
    /// What was assigned twice in one place.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    std::string name_;
    std::map<std::string, std::vector<RadValue>, std::less<>> values_;
    std::vector<std::string> warnings_;
};

/// Whether a file is called like one.
[[nodiscard]] inline bool is_rad_file_name(std::string_view name) {
    return name.ends_with(".rif");
}
/// Whether a word of a command line assigns a variable: "QUALITY=High".
[[nodiscard]] bool is_rad_assignment(std::string_view word);

/// Decode a rad file: a variable a line, `#` begins a comment, a `\` at the end of a line continues
/// it. Throws InputError "file:line: ..." for an unknown variable.
[[nodiscard]] RadFile decode_rad_file(std::string_view text, const std::string& name);

/// The words of a value; what stands in ' or " is one word. Throws InputError for a quote that does
/// not end.
[[nodiscard]] std::vector<std::string> words_of(const RadValue& value);

}  // namespace lightwalk
