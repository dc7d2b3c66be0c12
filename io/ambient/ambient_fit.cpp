#include "io/ambient/ambient_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/ambient/ambient_cache.h"
#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

/// The value of an option after it was written to a header with six digits.
constexpr double kPrecision = 1e-4;
/// A radius that stands at the least one: floats, and the file's reals, round it.
constexpr double kRounding = 1e-5;

struct Option {
    std::string name;
    std::vector<double> values;
};

/// The options that bear on ambient values.
std::vector<Option> ambient_options(const RenderOptions& o) {
    const auto av = [&](std::size_t k) { return static_cast<double>(o.ambient_value[k]); };
    return {{"-av", {av(0), av(1), av(2)}},
            {"-aw", {static_cast<double>(o.ambient_weight)}},
            {"-ab", {static_cast<double>(o.ambient_bounces)}},
            {"-aa", {o.ambient_accuracy}},
            {"-ad", {static_cast<double>(o.ambient_divisions)}},
            {"-as", {static_cast<double>(o.ambient_super_samples)}},
            {"-ar", {static_cast<double>(o.ambient_resolution)}}};
}

std::string text(const char* format, double value) {
    std::array<char, 64> buffer{};
    (void)std::snprintf(buffer.data(), buffer.size(), format, value);
    return buffer.data();
}

/// Separated by blanks; whole numbers with all their digits.
std::string text(const std::vector<double>& values) {
    std::string result;
    for (const double value : values) {
        const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
        if (!result.empty()) result += ' ';
        result += text(whole ? "%.0f" : "%g", value);
    }
    return result;
}

/// The last values that the header gives the option `wanted.name`, as many as `wanted` has; nothing
/// when there are none.
std::optional<std::vector<double>> find_option(const std::vector<std::string>& header,
                                               const Option& wanted) {
    std::optional<std::vector<double>> found;
    for (const std::string& line : header) {
        std::istringstream words(line);
        for (std::string word; words >> word;) {
            if (word != wanted.name) continue;
            std::vector<double> values;
            double value = 0;
            while (values.size() < wanted.values.size() && words >> word && parse_real(word, value))
                values.push_back(value);
            if (values.size() == wanted.values.size()) found = values;
        }
    }
    return found;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::abs(x - y) <= kPrecision * std::abs(y);
    });
}

std::optional<AmbientRecord> at_level(AmbientRecord record, int level) {
    if (level < 0 || level > 255) return std::nullopt;
    record.level = static_cast<std::uint8_t>(level);
    return record;
}

}  // namespace

AmbientFit::AmbientFit(const std::vector<std::string>& header, const RenderOptions& options,
                       const AmbientLimits& limits)
    : limits_(limits) {
    for (const Option& wanted : ambient_options(options)) {
        const auto found = find_option(header, wanted);
        if (!found || same(*found, wanted.values)) continue;
        difference_ += (difference_.empty() ? "" : ", ") + wanted.name + " " + text(*found) +
                       " (not " + text(wanted.values) + ")";
        // Beyond 255 levels no file has values.
        const double first = std::clamp(found->front(), -1e6, 1e6);
        if (wanted.name == "-ab") {
            level_shift_ = options.ambient_bounces - static_cast<int>(first);
        } else if (wanted.name == "-ar") {
            file_least_radius_ =
                ambient_limits(limits.origin, limits.size, limits.accuracy, static_cast<int>(first))
                    .least_radius;
            finer_ = limits.least_radius < file_least_radius_;
        }
    }
}

std::optional<AmbientRecord> AmbientFit::for_run(AmbientRecord record) const {
    // Values of little weight have fewer samples, and reach farther by this.
    const double stretch = 1 / std::sqrt(static_cast<double>(record.weight));
    const double least = limits_.least_radius * stretch, file_least = file_least_radius_ * stretch;
    auto& [shorter, longer] = record.radius;
    if (finer_ && std::abs(static_cast<double>(shorter) - file_least) <= kRounding * file_least) {
        shorter = static_cast<float>(least);
        longer = std::min(longer, 2 * shorter);
    }
    const auto most = static_cast<float>(limits_.most_radius);
    longer = std::min(longer, most);
    shorter = std::min(shorter, most);
    return at_level(record, record.level + level_shift_);
}

std::optional<AmbientRecord> AmbientFit::for_file(AmbientRecord record) const {
    return at_level(record, record.level - level_shift_);
}

std::string ambient_option_line(const RenderOptions& o) {
    std::string line = "lightwalk";
    for (const Option& option : ambient_options(o))
        line += " " + option.name + " " + text(option.values);
    line += text(" -dt %g", o.shadow_threshold) + text(" -dc %g", o.shadow_certainty);
    line += text(" -ss %g", o.specular_samples) + text(" -st %g", o.specular_threshold);
    return line + text(" -lr %.0f", o.reflection_limit) + text(" -lw %g", o.weight_limit);
}

}  // namespace lightwalk
