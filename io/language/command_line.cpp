#include "io/language/command_line.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "io/files/library_path.h"

namespace lightwalk {
namespace {

constexpr std::string_view kNeedsShell = "$`&<>(){}";

constexpr std::size_t kLongestInMessage = 60;

class CommandSplitter {
  public:
    explicit CommandSplitter(std::string_view text) : text_(text) {}

    std::optional<std::vector<Pipeline>> split() {
        while (supported_ && at_ < text_.size()) step();
        end_pipeline();
        if (!supported_) return std::nullopt;
        return std::move(pipelines_);
    }

  private:
    void step() {
        const char c = text_[at_];
        if (c == '\\') return escape();
        if (c == '\'') return single_quotes();
        if (c == '"') return double_quotes();
        ++at_;
        if (c == ' ' || c == '\t' || c == '\r') {
            end_word();
        } else if (c == '\n' || c == ';') {
            end_pipeline();
        } else if (c == '|') {
            end_stage();
            pipe_open_ = true;
        } else if (c == '#' && !in_word_) {
            at_ = std::min(text_.find('\n', at_), text_.size());
        } else if (kNeedsShell.find(c) != std::string_view::npos || (c == '~' && !in_word_)) {
            supported_ = false;
        } else {
            append(c);
            word_.pattern = word_.pattern || c == '*' || c == '?' || c == '[';
        }
    }

    void append(char c) {
        in_word_ = true;
        word_.text.push_back(c);
    }

    /// Backslash outside quotes: the next character stands for itself; a line end vanishes.
    void escape() {
        const std::string_view rest = text_.substr(at_ + 1);
        if (rest.empty()) {
            supported_ = false;
        } else if (rest[0] == '\n') {
            at_ += 2;
        } else if (rest.substr(0, 2) == "\r\n") {
            at_ += 3;
        } else {
            append(rest[0]);
            at_ += 2;
        }
    }

    void single_quotes() {
        const std::size_t end = text_.find('\'', at_ + 1);
        if (end == std::string_view::npos) {
            supported_ = false;
            return;
        }
        in_word_ = true;
        word_.text.append(text_.substr(at_ + 1, end - at_ - 1));
        at_ = end + 1;
    }

    void double_quotes() {
        in_word_ = true;
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            const char c = text_[at_];
            if (c == '$' || c == '`') supported_ = false;
            if (c == '\\' && at_ + 1 < text_.size()) {
                const char next = text_[at_ + 1];
                if (next == '"' || next == '\\' || next == '$' || next == '`') {
                    word_.text.push_back(next);
                    ++at_;
                    continue;
                }
                if (next == '\n') {
                    ++at_;
                    continue;
                }
            }
            word_.text.push_back(c);
        }
        if (at_ >= text_.size()) supported_ = false;
        ++at_;
    }

    void end_word() {
        if (!in_word_) return;
        in_word_ = false;
        command_.push_back(std::exchange(word_, {}));
    }

    void end_stage() {
        end_word();
        if (command_.empty() || command_[0].text == "!") {
            supported_ = false;  // a pipe with nothing before or behind it
            return;
        }
        pipeline_.push_back(std::exchange(command_, {}));
    }

    void end_pipeline() {
        end_word();
        if (command_.empty() && pipeline_.empty() && !pipe_open_) return;
        end_stage();
        pipe_open_ = false;
        pipelines_.push_back(std::exchange(pipeline_, {}));
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool supported_ = true, in_word_ = false, pipe_open_ = false;
    CommandWord word_;
    SimpleCommand command_;
    Pipeline pipeline_;
    std::vector<Pipeline> pipelines_;
};

/// `directory` as the beginning of a pattern that matches only itself.
std::string quote_pattern(const std::string& directory) {
    std::string result;
    for (const char c : directory) {
        if (c == '*' || c == '?' || c == '[' || c == '\\') result.push_back('\\');
        result.push_back(c);
    }
    return result;
}

std::vector<std::string> matches_of(const std::string& pattern, const std::string& directory,
                                    FileSource& files) {
    const std::string full = path_from(quote_pattern(directory), pattern);
    const std::size_t prefix = path_from(directory, pattern).size() - pattern.size();
    std::vector<std::string> names = files.matches(full);
    for (std::string& name : names) name.erase(0, prefix);
    return names;
}

}  // namespace

std::optional<std::vector<Pipeline>> split_command(std::string_view text) {
    return CommandSplitter(text).split();
}

std::vector<std::string> expand_patterns(const SimpleCommand& command, const std::string& directory,
                                         FileSource& files) {
    std::vector<std::string> words;
    for (const CommandWord& word : command) {
        std::vector<std::string> names;
        if (word.pattern) names = matches_of(word.text, directory, files);
        if (names.empty()) names.push_back(word.text);
        words.insert(words.end(), names.begin(), names.end());
    }
    return words;
}

std::string_view without_command_mark(std::string_view command) {
    if (command.starts_with('!')) command.remove_prefix(1);
    return command;
}

std::string abbreviate_command(const std::string& command) {
    std::string text(without_command_mark(command).substr(0, kLongestInMessage));
    const std::size_t end = text.find_first_of("\r\n");
    const bool cut = end != std::string::npos || command.size() > kLongestInMessage + 1;
    if (end != std::string::npos) text.resize(end);
    return "!" + text + (cut ? "..." : "");
}

std::string quoted_for_shell(std::string_view word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_+-.,/:=@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) {
        return std::string(word);
    }
    std::string result = "'";
    for (const char c : word) {
        if (c == '\'')
            result += "'\\''";
        else
            result.push_back(c);
    }
    return result + "'";
}

}  // namespace lightwalk
