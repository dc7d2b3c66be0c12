#include "io/options/frame_name.h"

#include <cctype>

#include "io/options/option_words.h"

namespace lightwalk {
namespace {

/// One conversion of a pattern: "%", digits, "d".
struct Conversion {
    std::size_t width = 0;
    bool zeros = false;    ///< padded with zeros, not blanks
    std::size_t size = 0;  ///< characters of the pattern
};

Conversion conversion_at(const std::string& pattern, std::size_t at) {
    std::size_t end = at + 1;
    while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0)
        ++end;
    const std::string digits = pattern.substr(at + 1, end - at - 1);
    if (end == pattern.size() || pattern[end] != 'd' || digits.size() > 3) {
        throw UsageError("file name \"" + pattern +
                         "\": expected one %d for the frame number and no other %");
    }
    const bool zeros = !digits.empty() && digits.front() == '0';
    const std::size_t width = digits.empty() ? 0 : static_cast<std::size_t>(std::stoi(digits));
    if (width > 99)
        throw UsageError("file name \"" + pattern + "\": frame number wider than 99 digits");
    return {width, zeros, end + 1 - at};
}

std::string padded(int number, const Conversion& conversion) {
    std::string digits = std::to_string(number);
    if (digits.size() >= conversion.width) return digits;
    const std::size_t missing = conversion.width - digits.size();
    if (!conversion.zeros) return std::string(missing, ' ') + digits;
    const std::size_t sign = number < 0 ? 1 : 0;
    return digits.substr(0, sign) + std::string(missing, '0') + digits.substr(sign);
}

}  // namespace

std::string frame_name(const std::string& pattern, int number) {
    std::string name;
    bool filled = false;
    for (std::size_t at = 0; at < pattern.size();) {
        if (pattern[at] != '%') {
            name += pattern[at++];
        } else if (pattern.compare(at, 2, "%%") == 0) {
            name += '%';
            at += 2;
        } else {
            const Conversion conversion = conversion_at(pattern, at);
            if (filled)
                throw UsageError("file name \"" + pattern + "\": more than one frame number");
            name += padded(number, conversion);
            filled = true;
            at += conversion.size;
        }
    }
    return name;
}

bool varies_by_frame(const std::string& pattern) {
    return frame_name(pattern, 0) != frame_name(pattern, 1);
}

}  // namespace lightwalk
