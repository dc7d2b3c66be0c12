#include "io/generators/xform_options.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/model/transform_args.h"
#include "io/language/command_line.h"
#include "io/language/tokenizer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxElements = 1000000;
constexpr std::size_t kMaxNesting = 64;

/// How many words belong to an option besides itself; nothing for a word that is no option.
std::optional<std::size_t> argument_count(const std::string& word) {
    if (word == "-c" || word == "-e" || word == "-I") return 0;
    if (word == "-n" || word == "-m" || word == "-a" || word == "-f") return 1;
    if (!is_transform_option(word)) return std::nullopt;
    if (word[1] == 'm') return 0;
    return word == "-t" ? 3 : 1;
}

[[noreturn]] void fail_at(const std::string& word) {
    throw InputError("xform: command line error at '" + word + "'");
}

/// The word after the option at `at`.
const std::string& argument_of(const std::vector<std::string>& options, std::size_t at) {
    if (at + 1 >= options.size()) fail_at(options[at]);
    return options[at + 1];
}

/// Where the option `name` stands first; the end when it does not.
std::size_t find_option(const std::vector<std::string>& options, const std::string& name) {
    std::size_t at = 0;
    while (at < options.size() && options[at] != name) {
        at += 1 + argument_count(options[at]).value_or(0);
    }
    return std::min(at, options.size());
}

/// One application from options without -a and -f.
XformStep parse_step(const std::vector<std::string>& options) {
    XformStep step;
    std::size_t at = 0;
    for (; at < options.size(); ++at) {
        const std::string& option = options[at];
        if (option == "-I") {
            step.invert = !step.invert;
        } else if (option == "-n") {
            if (!step.prefix.empty()) step.prefix += ".";
            step.prefix += argument_of(options, at++);
        } else if (option == "-m") {
            const std::string& name = argument_of(options, at++);
            if (step.surface_modifier.empty()) step.surface_modifier = name;
        } else if (option != "-c" && option != "-e") {
            break;
        }
    }
    const std::span<const std::string> rest(options.data() + at, options.size() - at);
    const ParsedTransform parsed = parse_transform(rest);
    if (parsed.words < rest.size()) fail_at(rest[parsed.words]);
    step.transform = parsed.transform;
    step.words.assign(rest.begin(), rest.end());
    return step;
}

/// Expands arrays and argument files, depth first.
class StepExpander {
  public:
    StepExpander(const std::function<std::string(const std::string&)>& read,
                 const std::function<void(const XformStep&)>& apply)
        : read_(read), apply_(apply) {}

    void expand(const std::vector<std::string>& options) {
        if (indices_.size() > kMaxNesting) {
            throw CommandError("xform: arrays nest more than " + std::to_string(kMaxNesting) +
                               " deep: does an argument file read itself?");
        }
        if (const std::size_t at = find_option(options, "-f"); at < options.size()) {
            expand_file(options, at);
        } else if (const std::size_t array = find_option(options, "-a"); array < options.size()) {
            expand_array(options, array);
        } else {
            apply_step(options);
        }
    }

  private:
    void expand_file(const std::vector<std::string>& options, std::size_t at) {
        const std::string& file = argument_of(options, at);
        const auto lines = read_argument_lines(read_(file));
        if (lines.empty()) throw InputError("xform: empty argument file \"" + file + "\"");
        if (indices_.empty()) letter_ = 'i';
        for (std::size_t i = 0; i < lines.size(); ++i) {
            expand_element(options, at, lines[i], i);
        }
    }

    void expand_array(const std::vector<std::string>& options, std::size_t at) {
        long count = 0;
        if (!parse_integer(argument_of(options, at), count) || count <= 0) fail_at("-a");
        check_elements(static_cast<std::size_t>(count));
        if (indices_.empty()) letter_ = 'a';
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            expand_element(options, at, {"-i", std::to_string(i)}, i);
        }
    }

    /// Replace the two words at `at` by `words` and go on.
    void expand_element(const std::vector<std::string>& options, std::size_t at,
                        const std::vector<std::string>& words, std::size_t index) {
        const auto place = options.begin() + static_cast<std::ptrdiff_t>(at);
        std::vector<std::string> element(options.begin(), place);
        element.insert(element.end(), words.begin(), words.end());
        element.insert(element.end(), place + 2, options.end());
        indices_.push_back(index);
        expand(element);
        indices_.pop_back();
    }

    static void check_elements(std::size_t count) {
        if (count <= kMaxElements) return;
        throw CommandError("xform: array of more than " + std::to_string(kMaxElements) +
                           " elements");
    }

    void apply_step(const std::vector<std::string>& options) {
        check_elements(++elements_);
        XformStep step = parse_step(options);
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            if (!step.prefix.empty())
                step.prefix += ".";
            else
                step.prefix += letter_;
            step.prefix += std::to_string(indices_[i]);
        }
        apply_(step);
    }

    const std::function<std::string(const std::string&)>& read_;
    const std::function<void(const XformStep&)>& apply_;
    std::vector<std::size_t>
        indices_;        ///< the element's index in each nested array, outermost first
    char letter_ = 'a';  ///< what names begin with when there is no -n
    std::size_t elements_ = 0;
};

}  // namespace

XformCommandLine parse_xform(std::span<const std::string> args) {
    XformCommandLine line;
    std::size_t at = 1;
    while (at < args.size() && !args[at].empty() && args[at][0] == '-') {
        const std::optional<std::size_t> count = argument_count(args[at]);
        if (!count || args.size() - at <= *count) fail_at(args[at]);
        if (args[at] == "-c") line.keep_commands = true;
        if (args[at] == "-e") line.keep_commands = false;
        at += 1 + *count;
    }
    at = std::min(at, args.size());
    line.options.assign(args.begin() + std::min<std::ptrdiff_t>(1, std::ssize(args)),
                        args.begin() + static_cast<std::ptrdiff_t>(at));
    line.files.assign(args.begin() + static_cast<std::ptrdiff_t>(at), args.end());
    for (const std::string& file : line.files) {
        if (!file.empty() && file[0] == '-') fail_at(file);
    }
    return line;
}

std::vector<std::vector<std::string>> read_argument_lines(const std::string& text) {
    std::vector<std::vector<std::string>> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t end = begin;
        while (end < text.size() && !(text[end] == '\n' && (end == begin || text[end - 1] != '\\')))
            ++end;
        std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        for (std::size_t at = line.find("\\\n"); at != std::string::npos;
             at = line.find("\\\n", at)) {
            line.replace(at, 2, " ");
        }
        SceneTokenizer tokens(line, "argument file");
        if (line[0] == '#') continue;
        std::vector<std::string> words;
        while (const std::optional<std::string_view> word = tokens.word())
            words.emplace_back(*word);
        if (!words.empty() && !words[0].empty() && words[0][0] == '!') words[0].erase(0, 1);
        if (!words.empty() && words[0].empty()) words.erase(words.begin());
        if (!words.empty() && words[0] == "xform") words.erase(words.begin());
        if (!words.empty()) lines.push_back(std::move(words));
    }
    return lines;
}

void for_each_step(const std::vector<std::string>& options,
                   const std::function<std::string(const std::string&)>& read,
                   const std::function<void(const XformStep&)>& apply) {
    StepExpander(read, apply).expand(options);
}

}  // namespace lightwalk
