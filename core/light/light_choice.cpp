#include "core/light/light_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightwalk {
namespace {

constexpr double kMostScale = 1000;

/// The size from which a sample is chosen in any case: what the others bring, over the number of
/// choices that are left for them.
double certain_size(std::span<const float> sizes, double sum, std::size_t wanted) {
    double certain = sum / static_cast<double>(wanted);
    for (;;) {
        double rest = 0;
        std::size_t large = 0;
        for (const float size : sizes) {
            const bool is_large = static_cast<double>(size) >= certain;
            large += is_large ? 1 : 0;
            rest += is_large ? 0 : static_cast<double>(size);
        }
        if (large == 0 || large >= wanted || !(rest > 0)) return certain;
        const double share = rest / static_cast<double>(wanted - large);
        if (!(share < certain)) return certain;
        certain = share;
    }
}

}  // namespace

void choose_lights(std::span<const float> sizes, std::size_t wanted, double random,
                   std::vector<LightChoice>& chosen) {
    chosen.clear();
    const double sum = std::accumulate(sizes.begin(), sizes.end(), 0.0);
    const bool measurable = std::isfinite(sum);
    const double certain = measurable ? certain_size(sizes, sum, wanted) : 0;
    double end = 0;  // of the sample, in shares of what is certain
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto size = static_cast<double>(sizes[i]);
        if (size == 0) continue;
        if (!measurable || size >= certain) {
            chosen.push_back({static_cast<std::uint32_t>(i), 1});
            continue;
        }
        const double share = std::max(size / certain, 1 / kMostScale);
        end += share;
        if (random >= end) continue;
        chosen.push_back({static_cast<std::uint32_t>(i), static_cast<float>(1 / share)});
        random += 1;
    }
}

}  // namespace lightwalk
