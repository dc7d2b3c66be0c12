#include "io/generators/surface_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

/// Where `u` lies among `count` values: the one before it, within the table, and how far after.
struct Place {
    std::size_t index;
    double fraction;
};

Place place_of(double u, std::size_t count) {
    const double last = static_cast<double>(count - 2);
    const double index = u >= 0 ? std::min(std::trunc(u), last) : 0;
    return {static_cast<std::size_t>(index), u - index};
}

double mix(double a, double b, double fraction) {
    return a * (1 - fraction) + b * fraction;
}

}  // namespace

std::vector<double> parse_numbers(std::string_view text, const std::string& where,
                                  std::size_t most) {
    constexpr std::string_view kBlanks = " \t\n\r\v\f";
    std::vector<double> numbers;
    std::int32_t line = 1;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = std::min(text.find_first_not_of(kBlanks, at), text.size());
        const std::string_view blanks = text.substr(at, begin - at);
        line += static_cast<std::int32_t>(std::ranges::count(blanks, '\n'));
        if (begin == text.size()) break;
        at = std::min(text.find_first_of(kBlanks, begin), text.size());
        const std::string_view word = text.substr(begin, at - begin);
        double value = 0;
        if (!parse_real(word, value)) {
            throw InputError({where, line}, "expected a number, found \"" +
                                                std::string(word.substr(0, 40)) + "\"");
        }
        if (numbers.size() == most) {
            throw InputError({where, line}, "more than " + std::to_string(most) + " numbers");
        }
        numbers.push_back(value);
    }
    return numbers;
}

SurfaceData::SurfaceData(std::string_view text, const std::string& where, std::size_t m,
                         std::size_t n, std::size_t channels)
    : values_(parse_numbers(text, where, text.size())),
      channels_(channels),
      scale_s_(static_cast<double>(m)),
      scale_t_(static_cast<double>(n)) {
    const std::size_t vertices = (m + 1) * (n + 1);
    if (values_.size() == vertices * channels) {
        columns_ = m + 1;
        rows_ = n + 1;
    } else if (values_.size() == m * n * channels) {
        columns_ = m;
        rows_ = n;
        offset_ = 0.5;
    } else {
        throw InputError({where, 0}, "bad number of data points: found " +
                                         std::to_string(values_.size()) + " numbers, expected " +
                                         std::to_string(vertices * channels) + " for vertices or " +
                                         std::to_string(m * n * channels) + " for cells");
    }
    if (columns_ < 2 || rows_ < 2) {
        throw InputError({where, 0}, "data need at least 2 points in each direction");
    }
}

double SurfaceData::value(std::size_t channel, double s, double t) const {
    const Place u = place_of(s * scale_s_ - offset_, columns_);
    const Place v = place_of(t * scale_t_ - offset_, rows_);
    const auto at = [&](std::size_t column, std::size_t row) {
        return values_[((v.index + row) * columns_ + u.index + column) * channels_ + channel];
    };
    return mix(mix(at(0, 0), at(1, 0), u.fraction), mix(at(0, 1), at(1, 1), u.fraction),
               v.fraction);
}

}  // namespace lightwalk
