#include "io/options/option_words.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxWordsOfExpansion = 4095;
constexpr std::size_t kMaxWordLength = 4095;
constexpr std::size_t kMaxWords =
    65536;  ///< of a whole command line: files that name files may multiply
constexpr std::string_view kBlanks = " \t\n\v\f\r";

std::vector<std::string> split(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
        words.emplace_back(text.substr(at, end - at));
        at = text.find_first_not_of(kBlanks, end);
    }
    return words;
}

std::vector<std::string> words_behind(const std::string& word, FileSource& files) {
    const std::string name = word.substr(1);
    if (word.front() == '$') {
        const std::optional<std::string> value = files.place(word);
        if (!value) throw UsageError("cannot expand '" + word + "': no such environment variable");
        return split(*value);
    }
    try {
        return split(files.read(name, kMaxWordsOfExpansion * (kMaxWordLength + 1)));
    } catch (const InputError& error) {
        throw UsageError("cannot expand '" + word + "': " + error.what());
    }
}

/// Number of single-letter edits (with exchanges of neighbours) from a to b.
/// Source: F. Damerau, "A technique for computer detection and correction of spelling errors", CACM
/// 7 (1964).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = a[i - 1] == b[j - 1] ? 0 : 1;
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + changed});
            const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (exchanged) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

OptionWords::OptionWords(std::vector<std::string> words, std::shared_ptr<FileSource> files)
    : files_(std::move(files)) {
    words_.reserve(words.size());
    for (std::string& word : words) words_.push_back({std::move(word), -1});
}

void OptionWords::expand() {
    const Word word = words_[at_];
    for (int source = word.source; source >= 0;
         source = sources_[static_cast<std::size_t>(source)].parent) {
        if (sources_[static_cast<std::size_t>(source)].name == word.text) {
            throw UsageError("cannot expand '" + word.text + "': it includes itself");
        }
    }
    const std::vector<std::string> inner = words_behind(word.text, *files_);
    const bool too_long = std::any_of(
        inner.begin(), inner.end(), [](const std::string& w) { return w.size() > kMaxWordLength; });
    if (too_long || inner.size() > kMaxWordsOfExpansion ||
        words_.size() + inner.size() > kMaxWords) {
        throw UsageError("cannot expand '" + word.text + "': too many words, or too long ones");
    }
    sources_.push_back({word.text, word.source});
    const int source = static_cast<int>(sources_.size()) - 1;
    std::vector<Word> replacement;
    replacement.reserve(inner.size());
    for (const std::string& text : inner) replacement.push_back({text, source});
    const auto here = words_.begin() + static_cast<std::ptrdiff_t>(at_);
    words_.insert(words_.erase(here), replacement.begin(), replacement.end());
}

bool OptionWords::at_option() {
    current_.clear();
    while (at_ < words_.size()) {
        const std::string& word = words_[at_].text;
        if (word.size() < 2 || (word.front() != '@' && word.front() != '$')) return true;
        expand();
    }
    return false;
}

std::vector<std::string> OptionWords::rest() const {
    std::vector<std::string> result;
    for (std::size_t i = at_; i < words_.size(); ++i) result.push_back(words_[i].text);
    return result;
}

void OptionWords::skip(std::size_t count) {
    at_ = std::min(at_ + count, words_.size());
    current_.clear();
}

std::string OptionWords::argument(std::string_view expected) {
    if (current_.empty()) current_ = words_[at_++].text;
    if (at_ >= words_.size()) {
        throw UsageError("option " + current_ + ": expected " + std::string(expected) +
                         ", found nothing");
    }
    return words_[at_++].text;
}

std::string OptionWords::text() {
    return argument("an argument");
}

double OptionWords::real() {
    const std::string word = argument("a number");
    double value = 0;
    if (!parse_real(word, value)) {
        throw UsageError("option " + current_ + ": expected a number, found \"" + word + "\"");
    }
    return value;
}

int OptionWords::integer() {
    const std::string word = argument("an integer");
    long value = 0;
    if (!parse_integer(word, value) || value < std::numeric_limits<int>::min() ||
        value > std::numeric_limits<int>::max()) {
        throw UsageError("option " + current_ + ": expected an integer, found \"" + word + "\"");
    }
    return static_cast<int>(value);
}

std::uint64_t OptionWords::unsigned_integer() {
    const std::string word = argument("a non-negative integer");
    std::uint64_t value = 0;
    bool good = !word.empty();
    for (const char c : word) {
        const auto digit = static_cast<std::uint64_t>(c - '0');
        good = good && c >= '0' && c <= '9' && value <= (UINT64_MAX - digit) / 10;
        if (good) value = value * 10 + digit;
    }
    if (!good) {
        throw UsageError("option " + current_ + ": expected a non-negative integer, found \"" +
                         word + "\"");
    }
    return value;
}

Rgb OptionWords::rgb() {
    const double r = real();
    const double g = real();
    const double b = real();
    return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

std::optional<bool> OptionWords::toggle(std::string_view name, bool current) {
    const std::string_view word = option();
    if (!word.starts_with(name) || word.size() > name.size() + 1) return std::nullopt;
    if (word == name) {
        skip(1);
        return !current;
    }
    const char sign = word.back();
    if (sign != '+' && sign != '1' && sign != '-' && sign != '0') return std::nullopt;
    skip(1);
    return sign == '+' || sign == '1';
}

std::vector<std::string> OptionWords::expanded() const {
    std::vector<std::string> result;
    result.reserve(words_.size());
    for (const Word& word : words_) result.push_back(word.text);
    return result;
}

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names) {
    constexpr std::size_t kMaxComparedLength = 40;
    if (word.size() > kMaxComparedLength) return std::nullopt;
    std::optional<std::string> best;
    std::size_t best_distance = word.size() > 4 ? 3 : 2;  // nearer than this
    for (const std::string& name : names) {
        const std::size_t distance = edit_distance(word, name);
        if (distance < best_distance) {
            best = name;
            best_distance = distance;
        }
    }
    return best;
}

std::string history_line(std::span<const std::string> words) {
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        const std::string_view inside = word.size() > 2
                                            ? std::string_view(word).substr(1, word.size() - 2)
                                            : std::string_view();
        const bool blank = word.empty() || word.find_first_of(kBlanks) != std::string::npos;
        if (!blank && inside.find_first_of("\"'") == std::string_view::npos) {
            line += word;
            continue;
        }
        const char quote = inside.find('"') != std::string_view::npos ? '\'' : '"';
        line += quote + word + quote;
    }
    std::replace(line.begin(), line.end(), '\n', ' ');  // a header line cannot hold a line end
    return line;
}

}  // namespace lightwalk
