#include "apps/progress_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace lightwalk {
namespace {

constexpr int kShortestBar = 8, kLongestBar = 40;  // [characters] without its brackets

std::string percent_text(double share) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%5.1f %%", 100 * std::clamp(share, 0.0, 1.0));
    return text.data();
}

std::string rate_text(double per_second) {
    std::array<char, 64> text{};
    if (per_second >= 1e6)
        std::snprintf(text.data(), text.size(), "  %.2f Mrays/s", per_second * 1e-6);
    else
        std::snprintf(text.data(), text.size(), "  %.1f krays/s", per_second * 1e-3);
    return text.data();
}

std::string bar_text(double share, int length) {
    const int filled = std::clamp(static_cast<int>(share * length), 0, length);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') +
           std::string(static_cast<std::size_t>(length - filled), '.') + "] ";
}

}  // namespace

std::string time_text(double seconds) {
    const long whole = std::lround(std::clamp(seconds, 0.0, 3.6e6));
    std::array<char, 64> text{};
    if (whole >= 3600)
        std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60,
                      whole % 60);
    else
        std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
    return text.data();
}

std::string progress_line(const ProgressState& state, int columns) {
    const int room = std::max(columns - 1, 0);
    const std::string percent = percent_text(state.done);
    const std::string left =
        state.seconds_left ? "  " + time_text(*state.seconds_left) + " left" : std::string();
    for (const std::string& words :
         {percent + rate_text(state.rays_per_second) + left, percent + left}) {
        const int bar = std::min(room - static_cast<int>(words.size()) - 3, kLongestBar);
        if (bar >= kShortestBar) return bar_text(state.done, bar) + words;
    }
    for (const std::string& words : {percent + left, percent}) {
        if (static_cast<int>(words.size()) <= room) return words;
    }
    return {};
}

}  // namespace lightwalk
