#include "core/cloud/pattern_code.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwalk {
namespace {

constexpr float kStepsAPower = 16;

std::array<float, 256> make_table() {
    std::array<float, 256> table{};
    for (std::size_t code = 1; code < table.size(); ++code)
        table[code] = std::exp2((static_cast<float>(code) - kNoPattern) / kStepsAPower);
    return table;
}

}  // namespace

std::uint8_t encode_pattern(float brightness) {
    if (!(brightness > 0)) return 0;
    const float code = std::round(kStepsAPower * std::log2(brightness)) + kNoPattern;
    return static_cast<std::uint8_t>(std::clamp(code, 0.0f, 255.0f));
}

float decode_pattern(std::uint8_t code) {
    static const std::array<float, 256> table = make_table();
    return table[code];
}

}  // namespace lightwalk
