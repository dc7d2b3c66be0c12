#include "core/model/transform_args.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace lightwalk {
namespace {

constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// The word without leading white space and without a leading '+' (which std::from_chars refuses).
std::string_view trim_front(std::string_view word) {
    const std::size_t first = word.find_first_not_of(" \t\n\r\v\f");
    if (first == std::string_view::npos) return {};
    word.remove_prefix(first);
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

/// One or more digits, starting at `at`; returns where they end.
std::size_t skip_digits(std::string_view word, std::size_t at) {
    while (at < word.size() && is_digit(word[at])) ++at;
    return at;
}

/// Whether the whole word is  -? (digits [. digits?] | . digits) ([eE] [+-]? digits)?
bool looks_real(std::string_view word) {
    std::size_t at = !word.empty() && word[0] == '-' ? 1 : 0;
    const std::size_t whole = skip_digits(word, at);
    std::size_t digits = whole - at;
    at = whole;
    if (at < word.size() && word[at] == '.') {
        const std::size_t fraction = skip_digits(word, at + 1);
        digits += fraction - at - 1;
        at = fraction;
    }
    if (digits == 0) return false;
    if (at < word.size() && (word[at] == 'e' || word[at] == 'E')) {
        ++at;
        if (at < word.size() && (word[at] == '+' || word[at] == '-')) ++at;
        const std::size_t exponent = skip_digits(word, at);
        if (exponent == at) return false;
        at = exponent;
    }
    return at == word.size();
}

Transform translation(const Vec3& d) {
    Transform t;
    t.forward.row[3] = d;
    t.inverse.row[3] = -d;
    return t;
}

Transform uniform_scaling(double f) {
    Transform t;
    for (std::size_t k = 0; k < 3; ++k) {
        t.forward.row[k] *= f;
        t.inverse.row[k] *= 1 / f;
    }
    t.scale = f;
    return t;
}

Transform mirroring(std::size_t axis) {
    Transform t;
    t.forward.row[axis] *= -1;
    t.inverse.row[axis] *= -1;
    t.scale = -1;
    return t;
}

Transform rotation(std::size_t axis, double degrees) {
    const double angle = degrees * (kPi / 180);
    const double c = std::cos(angle), s = std::sin(angle);
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Transform t;
    t.forward.row[u][u] = t.forward.row[v][v] = c;
    t.forward.row[u][v] = s;
    t.forward.row[v][u] = -s;
    t.inverse.row[u][u] = t.inverse.row[v][v] = c;
    t.inverse.row[u][v] = -s;
    t.inverse.row[v][u] = s;
    return t;
}

/// `t` applied n times, by squaring: the cost does not depend on what a file asks for.
Transform power(Transform t, long n) {
    Transform result;
    for (; n > 0; n /= 2) {
        if (n % 2 == 1) result = result * t;
        if (n > 1) t = t * t;
    }
    return result;
}

std::optional<std::size_t> axis_of(char letter) {
    if (letter < 'x' || letter > 'z') return std::nullopt;
    return static_cast<std::size_t>(letter - 'x');
}

struct Operation {
    Transform transform;
    std::size_t words = 0;
};

/// The operation at the beginning of `words`, `-i` excepted.
std::optional<Operation> parse_operation(std::span<const std::string_view> words) {
    const std::string_view option = words[0];
    if (!is_transform_option(option) || option == "-i") return std::nullopt;
    if (option[1] == 'm') return Operation{mirroring(*axis_of(option[2])), 1};
    const std::size_t count = option == "-t" ? 3 : 1;
    double value[3] = {};
    if (words.size() <= count) return std::nullopt;
    for (std::size_t k = 0; k < count; ++k) {
        if (!parse_real(words[k + 1], value[k])) return std::nullopt;
    }
    if (option == "-t") return Operation{translation({value[0], value[1], value[2]}), 4};
    if (option[1] == 'r') return Operation{rotation(*axis_of(option[2]), value[0]), 2};
    if (value[0] == 0 || !std::isfinite(1 / value[0])) return std::nullopt;
    return Operation{uniform_scaling(value[0]), 2};
}

}  // namespace

bool parse_real(std::string_view word, double& value) {
    const std::string_view digits = trim_front(word);
    if (!looks_real(digits)) return false;
    double parsed = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), parsed);
    if (result.ec == std::errc::result_out_of_range) {
        // Underflow gives zero, as in C; overflow is refused, as no coordinate or colour may be
        // infinite.
        const double approximate = std::strtod(std::string(digits).c_str(), nullptr);
        if (!std::isfinite(approximate)) return false;
        parsed = approximate;
    }
    value = parsed;
    return true;
}

bool parse_integer(std::string_view word, long& value) {
    const std::string_view digits = trim_front(word);
    long parsed = 0;
    const char* const end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, parsed);
    if (result.ec != std::errc() || result.ptr != end) return false;
    value = parsed;
    return true;
}

bool is_transform_option(std::string_view word) {
    if (word == "-t" || word == "-s" || word == "-i") return true;
    return word.size() == 3 && word[0] == '-' && (word[1] == 'r' || word[1] == 'm') &&
           axis_of(word[2]).has_value();
}

ParsedTransform parse_transform(std::span<const std::string> words) {
    const std::vector<std::string_view> views(words.begin(), words.end());
    return parse_transform(views);
}

const ParsedTransform& TransformMemo::parse(std::span<const std::string> words) {
    std::string key;
    for (const std::string& word : words) key.append(word).push_back('\0');
    const auto [entry, fresh] = known_.try_emplace(std::move(key));
    if (fresh) entry->second = parse_transform(words);
    return entry->second;
}

ParsedTransform parse_transform(std::span<const std::string_view> words) {
    ParsedTransform result;
    Transform group;
    long repeat = 1;
    while (result.words < words.size()) {
        const std::span<const std::string_view> rest = words.subspan(result.words);
        if (rest[0] == "-i") {
            long next = 0;
            if (rest.size() < 2 || !parse_integer(rest[1], next)) break;
            result.transform = result.transform * power(group, repeat);
            group = {};
            repeat = next;
            result.words += 2;
            continue;
        }
        const std::optional<Operation> operation = parse_operation(rest);
        if (!operation) break;
        group = group * operation->transform;
        result.words += operation->words;
    }
    result.transform = result.transform * power(group, repeat);
    return result;
}

}  // namespace lightwalk
