#include "io/photometry/number_words.h"

#include <algorithm>
#include <cmath>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

/// Far beyond what means anything, and far within what floats hold.
constexpr double kLargest = 1e12;

bool separates_numbers(char c) {
    return c == ' ' || c == ',' || (c >= '\t' && c <= '\r');
}

std::string found(std::string_view word) {
    return "found \"" + std::string(word) + "\"";
}

}  // namespace

std::string_view NumberWords::word(std::string_view what) {
    while (!rest_.empty() && separates_numbers(rest_.front())) {
        if (rest_.front() == '\n') ++where_.line;
        rest_.remove_prefix(1);
    }
    if (rest_.empty()) throw error("the file ends, expected " + std::string(what));
    const auto* end = std::ranges::find_if(rest_, separates_numbers);
    const std::string_view result = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(result.size());
    return result;
}

double NumberWords::real(std::string_view what) {
    const std::string_view text = word(what);
    double value = 0;
    if (!parse_real(text, value)) throw error(found(text) + ", expected " + std::string(what));
    if (!(std::abs(value) <= kLargest))
        throw error(found(text) + ", which is too large for " + std::string(what));
    return value;
}

double NumberWords::not_negative(std::string_view what) {
    const double value = real(what);
    if (value < 0)
        throw error("found a negative number, expected " + std::string(what) + " of at least 0");
    return value;
}

long NumberWords::integer(std::string_view what, long least, long most) {
    const double value = real(what);
    if (value != std::floor(value) || value < static_cast<double>(least) ||
        value > static_cast<double>(most)) {
        throw error("bad " + std::string(what) + ", expected a whole number from " +
                    std::to_string(least) + " to " + std::to_string(most));
    }
    return static_cast<long>(value);
}

std::size_t NumberWords::count(std::string_view what, long least) {
    const double value = real(what);
    if (value != std::floor(value) || value < static_cast<double>(least))
        throw error("bad " + std::string(what) + ", expected a whole number of at least " +
                    std::to_string(least));
    if (value > static_cast<double>(most_left()))
        throw error("bad " + std::string(what) + ": the file holds no more than " +
                    std::to_string(most_left()) + " numbers");
    return static_cast<std::size_t>(value);
}

std::vector<double> NumberWords::reals(std::size_t count, std::string_view what) {
    std::vector<double> values;
    values.reserve(std::min(count, most_left()));
    while (values.size() < count) values.push_back(real(what));
    return values;
}

std::vector<double> NumberWords::ascending(std::size_t count, std::string_view what) {
    std::vector<double> values;
    values.reserve(std::min(count, most_left()));
    while (values.size() < count) {
        const double value = real(what);
        if (!values.empty() && value <= values.back())
            throw error("found " + std::string(what) + " that is not larger than the one before");
        values.push_back(value);
    }
    return values;
}

}  // namespace lightwalk
