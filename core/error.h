#pragma once
// Errors that a user can cause, and the place where he can mend them.
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace lightwalk {

/// The name of an input file, shared by every location that refers to it.
class FileName {
  public:
    FileName() = default;
    FileName(std::string name)  // NOLINT(google-explicit-constructor): a name is a string
        : name_(name.empty() ? nullptr : std::make_shared<const std::string>(std::move(name))) {}
    FileName(const char* name) : FileName(std::string(name)) {}  // NOLINT: the same

    [[nodiscard]] bool empty() const { return !name_; }
    [[nodiscard]] std::string text() const { return name_ ? *name_ : std::string(); }
    friend bool operator==(const FileName& a, const FileName& b) {
        return a.name_ == b.name_ || (a.name_ && b.name_ && *a.name_ == *b.name_);
    }
    /// Whether both share one string in memory: a quick test that implies equality.
    [[nodiscard]] bool is(const FileName& other) const { return name_ == other.name_; }

  private:
    std::shared_ptr<const std::string> name_;
};

/// Where something stands in an input file. `line` counts from 1; 0 means "no line" (binary file,
/// option).
struct SourceLocation {
    FileName file;
    std::int32_t line = 0;
};

/// "file:line: ", or "file: " without a line, or "" without a file.
[[nodiscard]] inline std::string to_prefix(const SourceLocation& where) {
    if (where.file.empty()) return {};
    if (where.line <= 0) return where.file.text() + ": ";
    return where.file.text() + ":" + std::to_string(where.line) + ": ";
}

/// `text` as a terminal may show it: bytes that are neither white space, printable ASCII nor a
/// printable UTF-8 character become \xNN, and words of more than 1000 bytes are cut. For messages
/// that quote input, which may be anything.
[[nodiscard]] std::string printable(std::string_view text);

/// Bad input: `what()` is "file:line: what is wrong, what was expected". Programs print it and exit
/// with 1. It is printable(), whatever it quotes.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& message) : std::runtime_error(printable(message)) {}
    InputError(const SourceLocation& where, const std::string& message)
        : std::runtime_error(printable(to_prefix(where) + message)) {}
};

/// A file that a scene names does not exist. A caller that does not need its contents may catch
/// this and go on.
class MissingFile : public InputError {
  public:
    using InputError::InputError;
};

/// Receives warnings. Implementations must be callable from many threads at once and should limit
/// repetition.
class WarningSink {
  public:
    virtual ~WarningSink() = default;
    virtual void warn(const std::string& message) = 0;
};

}  // namespace lightwalk
